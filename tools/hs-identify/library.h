// The model library of hs-identify: a start from its nearest entry, and the result into it.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "cli/tool.h"
#include "io/stream.h"
#include "model/model_library.h"

namespace hapsim {

inline std::vector<Option> library_flags() {
  return {{.flag = "--library",
           .kind = OptionKind::kFile,
           .value = "FILE",
           .help = "Library of identified models (made when absent): the values of its nearest "
                   "entry are one more start of a new model, and the result is added to it; see "
                   "hs-library(1).",
           .group = "Library"},
          {.flag = "--material",
           .value = "NAME",
           .help = "Material, for --library; otherwise the recording's metadata material.",
           .group = "Library"},
          {.flag = "--object",
           .value = "NAME",
           .help = "Object, for --library; otherwise the recording's metadata object.",
           .group = "Library"}};
}

class IdentifyLibrary {
 public:
  // What is wrong with the library is told before the work begins; a new one is made with its first
  // entry, so that none is left empty by a run that fails.
  IdentifyLibrary(const Arguments& arguments, const Recording& recording, const TetMesh& body)
      : arguments_(arguments) {
    for (const char* flag : {"--material", "--object"})
      if (arguments.given(flag) && !arguments.given("--library"))
        fail_usage(std::string(flag) + " describes an entry of a library", "add --library FILE");
    if (!asked()) return;
    described_ = describe(recording, body);
    if (arguments.given("--material")) described_.material = arguments.text("--material");
    if (arguments.given("--object")) described_.object = arguments.text("--object");
    if (std::filesystem::exists(path())) {
      open();
    } else {
      const Output may_be_made(path());
    }
  }

  // One more start with the values of the nearest entry.
  void add_start(std::vector<Model>& starts) {
    if (!asked()) return;
    std::vector<LibraryEntry> entries;
    if (library_) entries = library_->entries();
    const LibraryEntry* nearest = nearest_entry(entries, described_, starts.front().effects());
    if (nearest == nullptr) return tell("it has no entry yet: the usual start");
    const auto start =
        with_values_of(starts.front(), nearest->model, same_object(nearest->described));
    if (!start) return tell("nothing to start from in the nearest, " + words_of(*nearest));
    starts.push_back(*start);
    tell("start values from the nearest, " + words_of(*nearest));
  }

  // Adds the model and does `commit`; when that fails the library stays as it was.
  template <class Commit>
  void store(const Model& model, const Commit& commit) {
    if (!asked()) return commit();
    if (!library_) open();
    Database::Transaction transaction(library_->database());
    const int id = library_->add(described_, model);
    commit();
    transaction.commit();
    tell(fmt::format("stored as entry {}", id));
  }

 private:
  bool asked() const { return arguments_.given("--library"); }
  std::string path() const { return arguments_.text("--library"); }
  void open() { library_.emplace(path(), Database::Mode::kWrite); }
  bool same_object(const Described& d) const {
    return !d.object.empty() && d.object == described_.object;
  }
  void tell(const std::string& text) const { say(arguments_, "hs-identify", path() + ": " + text); }

  const Arguments& arguments_;
  Described described_;
  std::optional<ModelLibrary> library_;
};

}  // namespace hapsim
