// Live motions of several tools, or of one that turns, whose forces are for hands.
#pragma once

#include <ostream>
#include <string>

#include "realtime/motion_feed.h"
#include "safety/hand_watch.h"
#include "safety/safe_tools.h"
#include "safety/safety_words.h"

namespace hapsim {

// What HandSource is for one tool that does not turn. A tool of which nothing comes any more, while
// others move, is lost by itself.
class HandTools : public ToolSource {
 public:
  HandTools(ToolSource& motion, const Input& input, const SafetyLimits& limits, std::ostream& out);

  std::size_t tools() const override { return motion_.tools(); }
  bool has_contact_point() const override { return motion_.has_contact_point(); }
  bool next(ToolStep& step) override;
  void write(std::string& buffer, const ToolStep& step,
             std::span<const ToolFeel> feel) const override;
  // The last answer: zero.
  void end();

  bool lost() const { return safe_.lost(); }
  const SafetyCounts& counts() const { return counts_; }

 private:
  void see(const ToolStep& step, double now);
  bool is_felt() const;
  void rest();
  void send(bool ends) const;
  void tell(std::string& buffer) const;

  ToolSource& motion_;
  const Input& input_;
  std::ostream& out_;
  struct Seen {
    Vec3 tip = Vec3::Zero(), turn = Vec3::Zero();
    double when = 0;  // [s]; 0: never
  };
  std::array<Seen, kMostTools> seen_;
  // What the hands have felt, and is written by who answers: the loop, or the watch under its lock.
  mutable SafeTools safe_;
  mutable SafetyCounts counts_;
  mutable ToolStep last_;
  mutable std::array<ToolFeel, kMostTools> felt_;
  mutable double moved_ = 0;  // when the last step was answered [s]
  mutable std::string text_;
  StepFeed feed_;
  mutable HandWatch watch_;  // after the feed, which takes the signals
};

}  // namespace hapsim
