// What is told of a body: lines for people, JSON for programs.
#pragma once

#include <string>
#include <vector>

#include "mesh/quality.h"
#include "tetmesh/body_mesh.h"

namespace hapsim {

// Notes, sizes and quality; `unit`: that the input was read in. `verbose`: histograms and the worst
// tetrahedra instead of the worst alone.
std::vector<std::string> body_lines(const TetMesh& mesh, const TetQuality& quality,
                                    const BodyReport& report, const std::string& unit,
                                    bool verbose);

// The same as JSON text (two spaces of indent, a newline at the end): sizes in SI, spreads and
// histograms of the quality, tetrahedra by region, the nodes of the contacts, the worst tetrahedra,
// the notes.
std::string body_json(const TetMesh& mesh, const TetQuality& quality, const BodyReport& report);

}  // namespace hapsim
