#include "identify/given_recordings.h"

#include <fmt/format.h>

#include "base/counted.h"
#include "base/error.h"
#include "experiment/contact_radius.h"
#include "experiment/plausible.h"
#include "fit/extend.h"
#include "fit/testable.h"
#include "recording/recording_join.h"

namespace hapsim {

void require_bodies_for(std::size_t bodies, std::size_t recordings) {
  if (bodies != 1 && bodies != recordings)
    fail_usage(
        fmt::format("{} for {}", counted(bodies, "body", "bodies"),
                    counted(recordings, "recording", "recordings")),
        "give --body once, or once for each recording: the main input first, then each --data");
}

void join_given(GivenRecordings& given, const std::vector<int>& body_of,
                std::vector<Recording> recordings, const Model& start) {
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    Recording& r = recordings[k];
    if (!start.parameters.empty())
      set_contact_radius(r, start);
    else if (recordings.size() == 1)
      set_contact_radius(r);
    // What is wrong with one of several is told with its file's name.
    if (recordings.size() > 1) require_presses(make_dataset(r));
    given.setup_of_row.insert(given.setup_of_row.end(), r.rows(), {body_of[k], r.disc_radius()});
  }
  given.dataset = make_dataset(join_recordings(recordings), given.setup_of_row);
  if (recordings.size() == 1) require_presses(given.dataset);
}

void require_fit_for(const FitRequest& request, const Dataset& dataset) {
  if (request.automatic) require_one_setup(dataset, "--effects auto");
  std::vector<std::string> effects = request.start.effects();
  effects.insert(effects.end(), request.add.begin(), request.add.end());
  require_shared(effects, dataset);
}

}  // namespace hapsim
