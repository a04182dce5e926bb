// SPDX-License-Identifier: GPL-3.0-or-later
#include "phiz/anatomy/thickness_table.h"

#include <algorithm>
#include <array>

#include "phiz/anatomy/sides.h"

namespace phiz {
namespace {

constexpr UsualThickness entry(std::string_view name, double millimetres, bool paired, bool on_mandible,
                               bool published = true) {
  return {name, 1e-3 * millimetres, 1e-3 * std::max(1.5, 0.3 * millimetres), paired, on_mandible, published};
}

constexpr bool midline = false, paired = true, skull = false, mandible = true, ours = false;

constexpr std::array table{
    entry("vertex", 5.0, midline, skull),
    entry("opisthocranion", 6.5, midline, skull),
    entry("trichion", 5.0, midline, skull, ours),
    entry("glabella", 5.5, midline, skull),
    entry("nasion", 6.5, midline, skull),
    entry("midNasal", 4.0, midline, skull),
    entry("rhinion", 3.0, midline, skull),
    entry("subnasale", 12.5, midline, skull),
    entry("midPhiltrum", 11.0, midline, skull),
    entry("labraleSuperius", 11.5, midline, skull),
    entry("labraleInferius", 13.0, midline, mandible),
    entry("mentolabialSulcus", 11.0, midline, mandible),
    entry("pogonion", 11.0, midline, mandible),
    entry("gnathion", 8.5, midline, mandible),
    entry("menton", 7.0, midline, mandible),
    entry("frontalEminence", 5.0, paired, skull, ours),
    entry("midSupraorbital", 6.0, paired, skull),
    entry("midInfraorbital", 7.0, paired, skull),
    entry("alarCurvature", 9.5, paired, skull),
    entry("lateralOrbit", 10.0, paired, skull),
    entry("temple", 10.0, paired, skull, ours),
    entry("zygion", 6.0, paired, skull),
    entry("euryon", 6.0, paired, skull, ours),
    entry("supraCanine", 9.5, paired, skull),
    entry("infraCanine", 10.5, paired, mandible),
    entry("supraSecondMolar", 26.0, paired, skull),
    entry("infraSecondMolar", 19.5, paired, mandible),
    entry("midRamus", 17.5, paired, mandible),
    entry("gonion", 10.0, paired, mandible),
    entry("midMandibularBorder", 10.5, paired, mandible),
};

}  // namespace

std::span<const UsualThickness> thickness_table() {
  return table;
}

const UsualThickness* find_usual_thickness(std::string_view landmark) {
  const std::string_view stem = without_side(landmark);
  const auto found = std::find_if(table.begin(), table.end(), [&](const UsualThickness& entry) {
    return entry.name == (entry.paired ? stem : landmark);
  });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace phiz
