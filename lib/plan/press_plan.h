// Which presses to record next: those that tell rival effects apart, or that determine a parameter.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiment/experiment.h"

namespace hapsim {

struct PlannedPress {
  std::string motion;     // "fast, held" and the like
  Vec3 position;          // contact point [m]
  double separation = 0;  // see MeasurementPlan
};

// A motion in the data format without forces, ready to be executed, with a piece of air before and
// after each press.
struct MeasurementPlan {
  std::vector<PlannedPress> presses;  // in the order of the motion
  Recording motion;
  // What all presses together promise. With rivals: how many standard deviations of the noise the
  // forces of one model stay away from the other, whatever the other's parameters do within what
  // the recording leaves them, at least over all pairs. With one model: the share that is left of
  // the standard error of its least certain parameter.
  double separation = 0;
  std::string parameter;  // the least certain one, or the one asked for; "" with rivals
  int region = 0;         // of that parameter
};

// What is asked of a plan beyond the usual.
struct PlanAsked {
  // Depth of a full press by place and outward normal [m]; empty: as any so far went into the
  // surface, while the deepest path stays above half of the way through.
  std::function<double(const Vec3&, const Vec3&)> depth_at;
  // "elastic E": what a plan for one model determines; "": the least certain.
  std::string parameter;
  int region = -1;             // of that parameter; -1: where it is the least certain
  std::vector<Vec3> places;    // further candidates, at which the tool is known to fit
  bool pressed_places = true;  // the recording's positions are candidates
};

// Tries at every position of the recording, and where the models say different things of other
// places at some of these as well (unpressed_places.h): shallow, as deep as the deepest, and half
// as deep again; slowly, fast, and fast with a hold; pushed sideways along two directions and their
// diagonal, and pushed to and fro. Picks them one by one, each the best on top of those before it
// (greedy D- and T-optimal design: Atkinson and Fedorov, Biometrika 62, 1975). Differences below 1
// % of the force count for nothing: no model is so good. `models` are fitted to the experiment's
// recording. With places in `asked`, these take the place of those that are found between the
// pressed ones.
MeasurementPlan plan_presses(const std::vector<Model>& models, const Experiment& experiment,
                             std::size_t count = 3, const PlanAsked& asked = {});

// What to record, and what for: the file of the motion, then a line a press.
std::vector<std::string> plan_lines(const MeasurementPlan& plan, const std::string& file);

}  // namespace hapsim
