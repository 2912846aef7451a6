// A model, its body and one press as the input of another finite-element program.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "mesh/tetmesh.h"
#include "model/model.h"
#include "recording/recording.h"
#include "solid/body_regions.h"

namespace hapsim {

struct Scene {
  std::string model_name, body_name;  // of the files, for error messages
  TetMesh mesh;                       // with the regions of the model, else with its own
  std::vector<double> modulus;        // Young's modulus by the model's regions [Pa], at rest
  double nu = 0.3;
  bool finite = false;  // neo-Hookean (hyperelastic_law.h); else Hooke's law, small strain
  std::vector<MaxwellTerm> terms;  // of the whole body: relaxation added to the modulus at rest
  std::vector<int> tool;           // nodes under the flat, bonded tool: they move together
  std::vector<double> t;  // [s], rising from above 0; without times in the recording 1, 2, ...
  std::vector<Vec3> u;    // displacement of the tool [m], one a time
  std::vector<std::string> remarks;  // become comments at the deck's head, a line each

  // Of a region that the body has and the model has not: that of the whole.
  double modulus_of(int region) const {
    const auto r = static_cast<std::size_t>(region);
    return modulus[r < modulus.size() ? r : 0];
  }
};

struct SceneOptions {
  std::size_t steps = 20;  // rows of the press that are kept, spread evenly, the deepest among them
  bool bare = false;       // leave out what acts on the motion and the sensor
};

// The tool's nodes are those of patch_under_tool(): the forces are those of the body's own mesh
// (hs-simulate --own-mesh). `press` empty: no tool and no motion. Error(kBadInput) naming the
// effect that has no such form: features solved on meshes of their own, a spherical tip, friction,
// stiffening beyond neo-Hooke, regions that relax each in its own way; sensor and motion unless
// `bare`. Error(kBadInput): a press off the surface.
Scene make_scene(const TetMesh& body, const Model& model, const Recording& recording,
                 const std::vector<int>& press, const SceneOptions& options);

// The remarks as comments of XML, in which no two dashes may follow each other.
void write_xml_remarks(std::ostream& out, const Scene& scene);

// By element, the label at its centre, or where `labels` is null the region of the material's
// nearest key point; 0 without key points.
std::vector<int> regions_of(const TetMesh& mesh, const MaterialSpec& material,
                            const BodyRegions* labels);

// CalculiX, Abaqus: a step for each time, RF summed over the node set TOOL printed after each (the
// force of the tool on the body). Error(kBadInput): relaxation, which CalculiX does not have.
void write_calculix(std::ostream& out, const Scene& scene);

// FEBio, febio_spec 4.0: the motion as load curves, the tool's nodal reactions in its log file.
// Hooke's law is FEBio's "isotropic elastic", which keeps the angles of large rotations: equal to
// first order in the strain.
void write_febio(std::ostream& out, const Scene& scene);

// SOFA, from 23.12: one XML scene with its mesh, a static solver and linear tetrahedra.
// Error(kBadInput): second order, finite strain, relaxation.
void write_sofa(std::ostream& out, const Scene& scene);

}  // namespace hapsim
