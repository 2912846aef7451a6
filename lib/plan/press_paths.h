// Presses that a tool can be told to do: paths in the frame of the contact, and their rows.
#pragma once

#include <string>
#include <vector>

#include "recording/recording.h"

namespace hapsim {

constexpr double kPauseBetweenPresses = 5;  // [s]

// A path of the tool: displacements in the frame of the contact (two tangents, depth), reached one
// after the other.
struct Leg {
  Vec3 to;  // tangent 1, tangent 2, depth [m]
  double seconds;
};
struct PressPath {
  std::string name;  // "fast 3 mm deep, held"
  std::vector<Leg> legs;
};

// Of the deepest path over a full press.
constexpr double kDeepestPath = 1.5;

// Shallow, as deep as `deepest` [m], and half as deep again; slowly, fast, and fast with a hold;
// pushed sideways along two directions and their diagonal, to and fro.
std::vector<PressPath> press_paths(double deepest);

// What the first presses of a body do, one after the other and then from the start again: each is
// another of these paths, so that few presses see depths, rates, holds and both directions
// sideways. The deepest comes first: what is pressed later goes no deeper.
const PressPath& path_in_turn(const std::vector<PressPath>& paths, std::size_t turn);

// The turns of paths that are held, or go sideways, slowly (path_in_turn()).
constexpr std::size_t kHeldTurn = 0, kSidewaysTurn = 1, kSlowTurn = 2;

// Appends one press along a path in steps of `step` [s], without forces, with a piece of air before
// and after it. `start`: time of its first row [s]. The first tangent is the x axis laid into the
// surface (the y axis where that stands upright on it).
void append_press(Recording& recording, int press, double start, double step, const Vec3& position,
                  const Vec3& normal, const PressPath& path);

}  // namespace hapsim
