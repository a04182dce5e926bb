// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/face/head_contacts.h"

#include <map>
#include <string>

#include "phiz/core/error.h"

namespace phiz {

HeadContacts::HeadContacts(const HeadTemplate& head, const ContactOptions& options)
    : scene(head.volume.V.rows(), options) {
  std::map<std::string, int> patches, rigid;
  const auto region = [&](const std::string& name) -> const ContactRegion* {
    for (const ContactRegion& r : head.contact_regions)
      if (r.name == name) return &r;
    return nullptr;
  };
  const auto patch = [&](const ContactRegion& r) {
    const auto found = patches.find(r.name);
    return found != patches.end() ? found->second
                                  : patches[r.name] = scene.add_patch(head.volume.V, r.triangles);
  };
  for (const ContactPair& pair : head.contact_pairs) {
    const ContactRegion* moving = region(pair.vertices);
    if (moving == nullptr) reject(head.name, "contact pair names the unknown region " + pair.vertices);
    const ContactRegion* other = region(pair.obstacle);
    int obstacle = -1;
    if (other != nullptr) {
      obstacle = patch(*other);
    } else if (const Part* part = find_part(head, pair.obstacle); part != nullptr) {
      const auto found = rigid.find(part->name);
      if (found != rigid.end()) {
        obstacle = found->second;
      } else {
        obstacle = rigid[part->name] = scene.add_rigid(part->mesh);
        if (part->carrier == Carrier::mandible) on_jaw.push_back(obstacle);
      }
    } else {
      reject(head.name, "contact pair names the unknown obstacle " + pair.obstacle);
    }
    scene.add_pair(moving->vertices, obstacle, moving->triangles.rows() > 0 ? patch(*moving) : -1, head.volume.V);
  }
}

void HeadContacts::place_jaw(const Eigen::Isometry3d& jaw) {
  for (const int obstacle : on_jaw) scene.place(obstacle, jaw);
}

}  // namespace phiz
