#include "experiment/preparation_flags.h"

#include "base/error.h"
#include "cli/shared_flags.h"
#include "contact/contact_cache.h"
#include "recording/contradictions.h"

namespace hapsim {

std::vector<Option> preparation_flags() {
  return {
      {.flag = flag::tool_radius,
       .value = "M",
       .help = "Radius of the flat tool [m]; otherwise the recording's metadata tool_radius.",
       .group = "Input",
       .minimum = 1e-6,
       .maximum = 1},
      {.flag = flag::noise,
       .value = "N",
       .help = "Standard deviation of the force noise per component [N]; otherwise the metadata "
               "force_noise, otherwise measured from differences of neighbours in time and the "
               "samples in the air.",
       .group = "Fit",
       .minimum = 1e-12},
      {.flag = flag::floor,
       .value = "SHARE",
       .help = "Gain error by position that mesh and scanned shape may cause and no effect is "
               "blamed for; otherwise the mesh's own uncertainty and that of a surface off the "
               "contact points, at least 0.01.",
       .group = "Fit",
       .minimum = 0,
       .maximum = 1},
      {.flag = flag::rim_edge,
       .value = "SHARE",
       .help = "Edge length of the finer contact mesh at the tool's rim, as a share of the radius; "
               "otherwise a sixth.",
       .group = "Fit",
       .minimum = 0.02,
       .maximum = 0.5},
      {.flag = flag::threads,
       .value = "N",
       .help = "Contact positions solved side by side; 0: as many as the machine has cores.",
       .group = "General",
       .default_text = "0",
       .minimum = 0,
       .maximum = 1024},
      {.flag = flag::cache,
       .value = "DIR",
       .help = "Where prepared stiffnesses are kept by content ('none': nowhere); otherwise the "
               "user's cache folder.",
       .group = "General"}};
}

ExperimentOptions preparation_options(const Arguments& arguments) {
  ExperimentOptions options;
  options.threads = static_cast<int>(arguments[flag::threads]);
  if (arguments.given(flag::rim_edge)) options.rim_edge = arguments[flag::rim_edge];
  if (arguments.given(flag::noise)) options.noise = arguments[flag::noise];
  if (arguments.given(flag::floor)) options.floor = arguments[flag::floor];
  options.cache = arguments.given(flag::cache) ? arguments[flag::cache] : default_cache_directory();
  if (options.cache == "none") options.cache.clear();
  return options;
}

std::string repeated_flags(const Arguments& arguments) {
  std::string words;
  for (const AnyFlag& flag : AnyFlags{flag::tool_radius, flag::noise, flag::floor, flag::rim_edge})
    if (arguments.given(flag)) words += " " + flag + " " + arguments.text(flag);
  return words;
}

Recording as_asked(const Arguments& arguments, Recording recording, bool need_forces,
                   const std::function<void(const std::string&)>& say) {
  const auto told = [&](const std::string& words) {
    if (!words.empty()) say(words);
  };
  if (arguments.given(flag::tool_radius)) {
    told(other_radius_words(recording.metadata, arguments[flag::tool_radius], recording.name));
    recording.metadata.set("tool_radius", arguments.text(flag::tool_radius));
  }
  recording.tool_radius();  // fails now when it is missing
  if (need_forces && recording.f.empty())
    fail_input(recording.name, "it is a motion without forces", "give a recording");
  if (need_forces && arguments.given(flag::noise))
    told(other_noise_words(recording, arguments[flag::noise], flag::noise.name));
  return recording;
}

}  // namespace hapsim
