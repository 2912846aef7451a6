// The model library of hs-identify: a start from its nearest entry, and the result into it.
#pragma once

#include <memory>

#include "base/error.h"
#include "cli/tool.h"
#include "hs-identify/flags.h"
#include "model/library_use.h"

namespace hapsim {

inline std::vector<Option> library_flags() {
  return {{.flag = flag::library,
           .value = "FILE",
           .help = "Library of identified models (made when absent): the values of its nearest "
                   "entry are one more start of a new model, and the result is added to it; see "
                   "hs-library(1).",
           .group = "Library"},
          {.flag = flag::material,
           .value = "NAME",
           .help = "Material, for --library; otherwise the recording's metadata material.",
           .group = "Library"},
          {.flag = flag::object,
           .value = "NAME",
           .help = "Object, for --library; otherwise the recording's metadata object.",
           .group = "Library"}};
}

// The library that is asked for, if one is.
inline std::unique_ptr<LibraryUse> asked_library(const Arguments& arguments,
                                                 const Recording& recording, const TetMesh& body) {
  for (const AnyFlag& flag : AnyFlags{flag::material, flag::object})
    if (arguments.given(flag) && !arguments.given(flag::library))
      fail_usage(flag + " describes an entry of a library", "add --library FILE");
  if (!arguments.given(flag::library)) return nullptr;
  Described described = describe(recording, body);
  if (arguments.given(flag::material)) described.material = arguments[flag::material];
  if (arguments.given(flag::object)) described.object = arguments[flag::object];
  return std::make_unique<LibraryUse>(
      arguments[flag::library], described,
      [&arguments](const std::string& text) { say(arguments, "hs-identify", text); });
}

}  // namespace hapsim
