// SPDX-License-Identifier: GPL-3.0-or-later
/// Where things are in the mesh of ICT Face Model Light: the tables of its README.
#pragma once

#include <array>

namespace phiz::face_kit {

/// Rows [first, end) of the vertices or of the faces.
struct Range {
  int first, end;
};

inline constexpr int vertex_count = 26719, face_count = 26384;

inline constexpr Range outer_faces{0, 11144};      ///< face, head, neck and shoulders
inline constexpr Range mouth_faces{11144, 13226};  ///< the sack behind the lips
inline constexpr Range left_socket_faces{13226, 13630}, right_socket_faces{13630, 14034};
inline constexpr Range skin_faces{0, 14034}, skin_vertices{0, 14062};
inline constexpr Range narrow_face_vertices{0, 6706};  ///< brows to chin, without cheeks and ears
inline constexpr Range gum_faces{14034, 17006}, gum_vertices{14062, 17039};
inline constexpr Range teeth_faces{17006, 21496}, teeth_vertices{17039, 21451};
inline constexpr Range upper_teeth_vertices{17039, 19247}, lower_teeth_vertices{19247, 21451};
inline constexpr Range upper_teeth_faces{17006, 19250}, lower_teeth_faces{19250, 21496};
inline constexpr Range left_eye_faces{21496, 23094}, right_eye_faces{23094, 24692};
inline constexpr Range left_eye_vertices{21451, 23021}, right_eye_vertices{23021, 24591};
inline constexpr Range left_sclera_vertices{21451, 22221}, right_sclera_vertices{23021, 23791};
/// Lashes: per eye three cards on the upper lid, then three on the lower one.
inline constexpr Range left_lash_faces{25304, 25844}, right_lash_faces{25844, 26384};
inline constexpr int lash_cards = 6, faces_per_lash_card = 90;

/// The 68 points of the usual markup.
inline constexpr std::array<int, 68> landmarks = {
    1225, 1888, 1052, 367,  1719, 1722, 2199, 1447, 966,  3661, 4390, 3927, 3924, 2608, 3272, 4088, 3443,
    268,  493,  1914, 2044, 1401, 3615, 4240, 4114, 2734, 2509, 978,  4527, 4942, 4857, 1140, 2075, 1147,
    4269, 3360, 1507, 1542, 1537, 1528, 1518, 1511, 3742, 3751, 3756, 3721, 3725, 3732, 5708, 5695, 2081,
    0,    4275, 6200, 6213, 6346, 6461, 5518, 5957, 5841, 5702, 5711, 5533, 6216, 6207, 6470, 5517, 5966};

/// Points 0 to 16 along the edge of the jaw itself instead of the outline that a camera in front sees.
inline constexpr std::array<int, 17> jaw_line = {1278, 1272, 12,   1834, 243,  781,  2199, 1447, 966,
                                                 3661, 4390, 3022, 2484, 4036, 2253, 3490, 3496};

/// A tooth that BodyParts3D has too (the third molars are the face kit's alone).
struct Tooth {
  Range vertices;
  int fma;
  bool upper;
};
inline constexpr std::array<Tooth, 28> teeth = {{
    {{17230, 17416}, 55700, true},  {{17416, 17607}, 55699, true},  {{17607, 17730}, 55691, true},
    {{17730, 17895}, 55690, true},  {{17895, 17991}, 55799, true},  {{17991, 18067}, 55683, true},
    {{18067, 18143}, 55682, true},  {{18143, 18219}, 55681, true},  {{18219, 18295}, 55680, true},
    {{18295, 18391}, 55798, true},  {{18391, 18556}, 55689, true},  {{18556, 18679}, 55688, true},
    {{18679, 18870}, 55698, true},  {{18870, 19056}, 55697, true},  {{19426, 19602}, 55703, false},
    {{19602, 19814}, 55704, false}, {{19814, 19952}, 55692, false}, {{19952, 20079}, 55693, false},
    {{20079, 20169}, 55687, false}, {{20169, 20263}, 57141, false}, {{20263, 20349}, 57143, false},
    {{20349, 20435}, 57142, false}, {{20435, 20529}, 57140, false}, {{20529, 20619}, 55686, false},
    {{20619, 20746}, 55694, false}, {{20746, 20884}, 55695, false}, {{20884, 21096}, 55705, false},
    {{21096, 21272}, 55706, false},
}};

}  // namespace phiz::face_kit
