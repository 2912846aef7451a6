// What a watched stream has shown: in words as it comes, and as a table.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "watch/watch.h"

namespace hapsim {

// What was learned as usual, and which changes it lets go unnoticed; after learning.
std::string usual_words(const ModelWatch& watch, const WatchOptions& options);

// What has changed, since when, and how well the correction explains it.
std::string named_words(const WatchEvent& event);

// What a change that is refined has come to at the time t [s]; empty where there is nothing to say.
std::string refined_words(const WatchEvent& event, double t);

// The news of a watch, each told once.
class WatchNews {
 public:
  // `watch` outlives it; `options` are those it was made with.
  WatchNews(const ModelWatch& watch, const WatchOptions& options)
      : watch_(watch), options_(options) {}
  // Sentences about what has happened since the last call, up to the sample at the time t [s].
  std::vector<std::string> next(double t);

 private:
  const ModelWatch& watch_;
  WatchOptions options_;
  std::size_t told_ = 0, refined_ = 0;  // events
  bool learned_ = false;
};

// The changes that the stream of a tool has shown; of one tool without a name the name is empty.
struct ToolEvents {
  std::string tool_id;
  std::vector<WatchEvent> events;
};

// A row a change (CSV): its times [s] (updated: empty while it was not), kind, and the correction
// in all: stiffness (0: the body is gone), bias [N], shift and its standard error [m], relaxation
// and slowness; the error it leaves [N] and the presses it rests on; of tools with names tool_id.
void write_events(std::ostream& out, const std::vector<ToolEvents>& tools);

}  // namespace hapsim
