// A flat tool's contact as rings of springs that slip: what friction leaves of the force of a tool
// that holds.
#pragma once

#include <Eigen/Core>
#include <array>

namespace hapsim {

// A body of finite strain under a flat tool that holds: the force that moves the tool at a depth
// and a way aside, in axes of the place and by ways over the tool's radius.
struct RimHeld {
  double normal = 0;               // [force]
  Eigen::Vector2d along, couples;  // along the surface, and how `normal` changes with the way aside
  Eigen::Matrix2d stiffness;       // of `along`
};

// Depths and ways in tool radii, forces in any unit. The contact is kRings rings of kSectors parts.
// Part (j, k), which lies in the direction r_k, has slipped by s_jk, and at the way aside x bears
// of the held force sideways f_t and of its stiffness K
//   q_jk = w_j [f_t(m) + K (x + e_j r_k - s_jk - m)] - sum over neighbours of k K (s_jk - s),
// m being the way at which a tool that holds would bear what all parts do together. By e_j = a_j d
// + b_j d^2 the body would draw the ring inwards at the depth d: the rim of a tool that goes
// straight in slips by that, and of one that goes out the other way. A part that slips leaves to
// its neighbours what it does not bear; without these springs no numbers fit more than one motion.
// A part slips where |q_jk| would be more than its share of mu N (Coulomb). The normal force is the
// held one at m, less what the parts' energy has of d: g(d) tr(K)/2 sum w_j e_j'(d) r_k . s_jk.
// Parts side by side that slip one after another are those of Iwan (J. Appl. Mech. 33, 1966), here
// in two directions and drawn by the depth.
struct RimSlip {
  static constexpr int kRings = 5, kSectors = 6, kParts = kRings * kSectors;
  static constexpr int kReturns = 9;
  static constexpr double kReturnStep = 0.3;                                       // tool radii
  static constexpr std::array<double, kRings> kWeight{0.4, 0.25, 0.2, 0.1, 0.05};  // w, from inside

  double friction = 0;
  std::array<double, kRings> bound{};       // of mu N, over its weight; with weights 1 together
  std::array<double, kRings> drawn{};       // a
  std::array<double, kRings> drawn_more{};  // b
  // g at multiples of kReturnStep, straight between: 1, were springs to the neighbours all that is
  // beside a part's own.
  std::array<double, kReturns> returns{};
  std::array<double, kRings - 1> between{};  // k from ring to ring
  double around = 0;                         // and over the weight from sector to sector

  // What has slipped, and the way m: plain data.
  struct State {
    Eigen::Matrix<double, 2, kParts> slip = Eigen::Matrix<double, 2, kParts>::Zero();
    Eigen::Vector2d way = Eigen::Vector2d::Zero();
  };
  static constexpr int kNumbers = 2 * (kParts + 1);

  struct Force {
    double normal = 0;
    Eigen::Vector2d along = Eigen::Vector2d::Zero();    // |along| <= friction * normal
    Eigen::Vector2d slipped = Eigen::Vector2d::Zero();  // mean of the parts, by weight
  };

  // Goes on from `state` to the depth and way aside. `held`: RimHeld of a way aside at this depth,
  // asked once where the way at which the body is held is hardly another than before. Allocates and
  // throws nothing where that does not.
  template <class Held>
  Force step(double depth, const Eigen::Vector2d& aside, State& state, Held&& held) const noexcept {
    constexpr int kRounds = 6;
    constexpr double kEnd = 0.005;  // tool radii: what is linearised about m is as good there
    const State before = state;
    Force force;
    for (int round = 0; round < kRounds; ++round) {
      state.slip = before.slip;
      const Eigen::Vector2d about = state.way;
      force = settle(depth, aside, held(about), state);
      if ((state.way - about).norm() <= kEnd) break;
    }
    return force;
  }

 private:
  // The same with the body linearised about state.way.
  double returns_at(double depth) const noexcept;
  Force settle(double depth, const Eigen::Vector2d& aside, const RimHeld& held,
               State& state) const noexcept;
};

}  // namespace hapsim
