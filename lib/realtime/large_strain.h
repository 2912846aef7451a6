// The force of a body of finite strain anywhere on its surface, within microseconds.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "experiment/forces.h"
#include "mesh/signed_distance.h"
#include "realtime/place_facts.h"
#include "realtime/strain_sample.h"
#include "realtime/strain_slip.h"

namespace hapsim {

struct LargeStrainOptions {
  double tool_radius = 0;         // of the flat tool [m]
  double tolerance = 0.02;        // of samples left out, relative error of the force, rms
  std::size_t most_samples = 96;  // the tolerance may then not be reached
  std::vector<Vec3> near;         // places within kNear radii of these alone; empty: anywhere
  bool memory = false;            // samples have what bodies that relax ask for
  bool slips = false;             // the flat tool, by an effect of the model
  int threads = 0;                // 0: as many as the machine has
  std::string cache;              // directory of samples, "" for none
  std::function<void()> sampled;  // called at each (from any thread)
};

// The static force that moves the tool by u at a place is the gradient of an energy,
//   W = u.K u / 2 + k a^2 sum_s w_s P_s(R_s u / a),  k = n.K n,
// K the linear stiffness of the place, a the tool's radius, P_s what StrainSample s has beyond the
// linear energy, R_s the turn that takes the place's normal to the sample's, and w_s the weights of
// a Gaussian process with a constant mean (Rasmussen and Williams, Gaussian Processes for Machine
// Learning, 2006, 2.2) over place, normal and what the stiffness there says of edges and thickness.
// So no closed way at a place does work, and small displacements are those of the linear body.
// Nothing is changed after construction, which any number of threads may read.
class LargeStrain {
 public:
  static constexpr double kDeepest = 2.5;  // tool radii; nor deeper than 0.35 of the way through
  static constexpr double kNear = 3;
  static constexpr double kLinearPull = 0.1;  // out of the body, in tool radii: within 1 %

  // Solves places until what samples say of those left out is within the tolerance; each is stored
  // in the cache as it comes, so that a run that was ended goes on from there. `surface` and
  // `facts` of the prepared body outlive it. Cost: some 3 to 13 s of a processor a sample.
  // Error(kBadInput): the model has no hyperelastic effect of finite strain, or the tool fits
  // hardly anywhere.
  LargeStrain(const TetMesh& body, const Model& model, const StiffnessField& field,
              const SignedDistance& surface, const PlaceFacts& facts,
              const LargeStrainOptions& options);

  static constexpr int kMostNeighbours = 16;
  // What is known of a place: plain data.
  struct Place {
    int count = 0;
    std::array<int, kMostNeighbours> sample = {};
    std::array<double, kMostNeighbours> weight = {};
    std::array<Eigen::Matrix3d, kMostNeighbours> A = {};  // R_s over the radius, in s's frame
    Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
    Vec3 normal = Vec3::UnitZ();
    double stiffness = 0;  // n.K n [N/m]
    double into = 0;       // depth to which the forces hold [m]
    double aside = 1;      // strain_side()
    double doubt = 0;      // standard, of what is beyond the linear force, over that
    double fit = 0;        // standard, of the force, over that
    double memory = 0;     // standard, of what is remembered at first order, over that
  };
  struct Force {
    Vec3 f = Vec3::Zero();       // that moves the tool [N]
    Vec3 beyond = Vec3::Zero();  // of that what is not the linear force
    double doubt = 0;            // standard relative uncertainty of it, beside that of K
    bool within = true;          // false: beyond what was solved, along the tangent from there
  };
  // What a body that relaxes has beside at a place: m'(u)' C h is the force that moves a tool at u
  // for what the body's Maxwell elements remember, h being their memories of m (strain_memory.h),
  // in axes that stay the loop's.
  struct Memory {
    Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  // rows: into the surface, and along it
    StrainMemory at;                                      // [N] for gradients by u over the radius
  };
  // Allocate and throw nothing.
  Place at(const StepPlace& place) const noexcept;
  Force force(const Place& place, const Vec3& u) const noexcept;
  double energy(const Place& place, const Vec3& u) const noexcept;  // [J]; where it is within
  Eigen::Matrix3d tangent(const Place& place, const Vec3& u) const noexcept;  // [N/m]
  // Of a tool that slips; nothing where that was not asked for, or no place could be solved.
  const std::optional<StrainSlip>& slip() const { return slip_; }
  // Samples have it. `memory.frame`: as it was, for the normal `before`; turned to the place's.
  // remember() at a new place took 0.5 ms of five samples, beside other work; a step a hundredth.
  bool remembers() const { return options_.memory; }
  void remember(const Place& place, const Vec3& before, Memory& memory) const noexcept;
  MemoryPoint memory_point(const Place& place, const Memory& memory, const Vec3& u) const noexcept;

  std::size_t samples() const { return samples_.size(); }
  // Relative error of the force at samples left out (floor 5 % of the largest), rms.
  double left_out_error() const { return left_out_; }

 private:
  struct Known {  // of a sample's place, as the live loop knows it
    StrainSample sample;
    Eigen::Matrix<double, 9, 1> at;  // coordinates
    Vec3 normal;                     // of the surface
  };
  Eigen::Matrix<double, 9, 1> coordinates(const StepPlace& place) const noexcept;
  double covariance(const Eigen::Matrix<double, 9, 1>& a,
                    const Eigen::Matrix<double, 9, 1>& b) const noexcept;
  // u as what was solved and what goes on from there along the tangent.
  struct Held {
    Vec3 held, rest;
    double depth, into, side, most;
  };
  Held hold(const Place& place, const Vec3& u) const noexcept;
  void neighbours(const double* weight, const StepPlace& at, Place& place) const noexcept;
  void add(std::vector<StepPlace> places);
  void relate();
  void add_slip(const Model& model);
  std::vector<StepPlace> draw(std::size_t count, std::uint64_t seed) const;
  std::vector<StepPlace> apart(const std::vector<StepPlace>& pool, std::size_t count) const;

  static constexpr int kMostSamples = 512;
  const TetMesh& body_;
  Model model_;
  const StiffnessField& field_;
  const SignedDistance& surface_;
  const PlaceFacts& facts_;
  LargeStrainOptions options_;
  ContactBase base_;
  std::string key_;
  std::vector<Known> samples_;
  std::vector<Vec3> tried_;
  std::string refused_;                // why the last place was
  std::array<double, 4> length_ = {};  // of the process: place, normal, stiffness, its second part
  double second_ = 0, nugget_ = 0;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> inverse_;
  double variance_ = 0;        // of the relative doubt, for a process of variance one
  StrainMeshError mesh_ = {};  // the largest of samples that were compared with finer elements
  double left_out_ = 0;
  std::optional<StrainSlip> slip_;
};

// Its law is one of finite strain, which elements solve as it is (FullSpec::finite).
bool is_finite_strain(const EffectInstance& effect);
// Elements were pressed by a flat tool, held and (`slips`) slipping, and the effect's tool is
// another (it slips, it is a ball): at finite strain its law beside them was not verified.
bool touches_otherwise(const EffectInstance& effect, bool slips);
// Coulomb's coefficient of a flat tool that slips; infinite of all other effects.
double flat_friction(const EffectInstance& effect);

// The part of a model that stands still: body and support without what relaxes, to be solved by
// elements of finite strain, `slips`: and what makes the tool slip. Error(kBadInput) without
// hyperelastic, finite = 1.
Model static_part(const Model& model, bool slips = false);

}  // namespace hapsim
