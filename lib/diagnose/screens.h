// Effects that finite elements are solved for, tried at some of many places first.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "diagnose/candidate.h"
#include "diagnose/departures.h"

namespace hapsim {

// Whether there are so many places that some of them tell which of these effects are worth solving
// for at all.
bool has_many_places(const Dataset& dataset);

// What acts everywhere is tried at places spread over all, what is local at those about the place
// that departs most. Made when first asked for; the arguments must outlive it.
class Screens {
 public:
  Screens(const Baseline& base, const TrialGround& ground, const Departures& departures);
  ~Screens();
  Screens(const Screens&) = delete;
  Screens& operator=(const Screens&) = delete;

  struct Tried {
    // Error over that of the baseline, finite elements solved: on the screen, and so foretold at
    // all places, of which a local effect changes those of its screen alone.
    double left_there = 1, left = 1;
    Model model;  // where a fit at all places begins
    std::size_t places = 0;
  };
  // What by estimates leaves more than the share `worth` on the screen is not solved for. Nothing
  // where the effect cannot be tried (`lack` says why).
  std::optional<Tried> try_effect(const Effect& effect, double worth, std::string& lack);

 private:
  struct Screen;
  const Baseline& base_;
  const TrialGround& ground_;
  Vec3 where_;
  std::unique_ptr<Screen> everywhere_, local_;
};

}  // namespace hapsim
