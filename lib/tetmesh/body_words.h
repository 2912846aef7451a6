// What is told of a body: lines for people, JSON for programs.
#pragma once

#include <string>
#include <vector>

#include "cli/summary.h"
#include "mesh/quality.h"
#include "tetmesh/body_mesh.h"

namespace hapsim {

// On a screen: sizes, what holds the body, quality, notes; `unit`: that the input was read in.
// `verbose`: histograms and the worst tetrahedra instead of the worst alone.
Summary body_summary(const TetMesh& mesh, const TetQuality& quality, const BodyReport& report,
                     const std::string& unit, bool verbose);

// The same as JSON text (two spaces of indent, a newline at the end): sizes in SI, spreads and
// histograms of the quality, tetrahedra by region, the nodes of the contacts, the worst tetrahedra,
// the notes.
std::string body_json(const TetMesh& mesh, const TetQuality& quality, const BodyReport& report);

// What to know of a support too small to carry the body, as a bottom of a few triangles is: what is
// bonded yields about as much as a disc of its area does, so it is weak where that disc is small
// beside the body. "": it is sound, or nothing is bonded.
std::string weak_support_words(const TetMesh& mesh);

}  // namespace hapsim
