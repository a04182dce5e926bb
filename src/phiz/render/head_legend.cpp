// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/render/head_maps.h"
#include "phiz/render/head_view.h"
#include "phiz/render/muscle_surfaces.h"
#include "phiz/render/palette.h"

namespace phiz {

namespace {

std::vector<LegendEntry> muscle_legend(const HeadTemplate& head, const HeadViewOptions& options) {
  std::vector<LegendEntry> legend;
  int last = -1;
  for (const detail::ShownMuscle& muscle : detail::shown_muscles(head, options)) {
    if (muscle.kind <= last) continue;  // the other side
    last = muscle.kind;
    legend.push_back(
        {detail::readable(detail::muscle_stem(head.muscles[muscle.row].name)), detail::colour_of(muscle, options)});
  }
  return legend;
}

}  // namespace

std::vector<LegendEntry> head_legend(const HeadTemplate& head, const HeadViewOptions& options) {
  std::vector<LegendEntry> legend;
  switch (options.style) {
    case HeadStyle::muscles:
    case HeadStyle::anatomy:
      if (options.muscle_colours) legend = muscle_legend(head, options);
      break;
    case HeadStyle::fibres:
      legend = options.muscle_colours ? muscle_legend(head, options)
                                      : std::vector<LegendEntry>{{"origin", detail::origin_colour()},
                                                                 {"insertion", detail::insertion_colour()}};
      break;
    case HeadStyle::cutaway:
      legend = {{"skin", tissue_colour::skin},
                {"fat and other flesh", tissue_colour::flesh},
                {"skull", tissue_colour::skull},
                {"mandible", tissue_colour::mandible},
                {"rigid: inside of bones", tissue_colour::cavity},
                {"teeth", tissue_colour::tooth},
                {"gums", tissue_colour::gum},
                {"tongue", tissue_colour::tongue},
                {"eyes", tissue_colour::eye}};
      if (options.muscle_colours)
        for (const LegendEntry& entry : muscle_legend(head, options)) legend.push_back(entry);
      else
        legend.insert(legend.begin() + 2, {"muscle", tissue_colour::muscle});
      break;
    case HeadStyle::attachments:
      legend = {{"grown to the bone", detail::pinned_colour()},
                {"slides over the bone", detail::sliding_colour()},
                {"free", detail::bare_bone_colour()}};
      break;
    case HeadStyle::contacts:
      for (std::size_t r = 0; r < head.contact_regions.size(); ++r)
        legend.push_back({detail::readable(head.contact_regions[r].name), category_colour(static_cast<int>(r))});
      break;
    default:
      break;
  }
  return legend;
}

}  // namespace phiz
