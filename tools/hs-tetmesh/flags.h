// The flags of hs-tetmesh.
#pragma once

#include "cli/shared_flags.h"

namespace hapsim {

namespace flag {
inline constexpr LengthFlag edge{"--edge"}, size{"--size"};
inline constexpr NumberFlag max_volume{"--max-volume"}, radius_edge{"--radius-edge"},
    min_dihedral{"--min-dihedral"}, growth{"--growth"};
inline constexpr SwitchFlag normal{"--normal"}, preserve_surface{"--preserve-surface"},
    remesh{"--remesh"}, ascii{"--ascii"};
inline constexpr ChoiceFlag order{"--order"}, gmsh_version{"--gmsh-version"};
inline constexpr FileFlag curved_to{"--curved-to"}, region{"--region"}, contacts{"--contacts"},
    vtu{"--vtu"}, gmsh{"--gmsh"}, inp{"--inp"};
inline constexpr TextFlag fixed{"--fixed"}, contact_meshes{"--contact-meshes"}, unit{"--unit"},
    tetgen{"--tetgen"};
inline constexpr TimeFlag time_limit{"--time-limit"};
}  // namespace flag

}  // namespace hapsim
