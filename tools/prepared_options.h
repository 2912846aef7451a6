// How the tools that answer at once make a body ready.
#pragma once

#include <memory>

#include "cli/tool.h"
#include "contact/contact_cache.h"
#include "realtime/prepared_body.h"

namespace hapsim {

// With the user's cache, so that a second start finds the field; samples are counted in `progress`,
// which must outlive the preparation.
inline PreparedBodyOptions prepared_options(const Arguments& arguments, double tool_radius,
                                            std::shared_ptr<Progress>& progress) {
  PreparedBodyOptions options;
  options.tool_radius = tool_radius;
  options.cache = default_cache_directory();
  options.progress = [&arguments, &progress](std::size_t most) -> std::function<void()> {
    progress = std::make_shared<Progress>(arguments, "samples of the contact stiffness", most);
    return [&progress] { progress->step(); };
  };
  return options;
}

}  // namespace hapsim
