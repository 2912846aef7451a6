// The model library of an identification: a start from its nearest entry, and the result into it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/model_library.h"

namespace hapsim {

class LibraryUse {
 public:
  // What is wrong with the library is told before the work begins; a new one is made with its first
  // entry, so that none is left empty by a run that fails. `say`: takes what was found and stored,
  // in words that begin with `path`.
  LibraryUse(const std::string& path, const Described& described,
             std::function<void(const std::string&)> say);

  // One more start with the values of the nearest entry, where there is one that has something to
  // take.
  void add_start(std::vector<Model>& starts);

  // Adds the model and does `commit`; when that fails the library stays as it was.
  void store(const Model& model, const std::function<void()>& commit);

 private:
  void open() { library_.emplace(path_, Database::Mode::kWrite); }
  void tell(const std::string& text) const { say_(path_ + ": " + text); }

  std::string path_;
  Described described_;
  std::function<void(const std::string&)> say_;
  std::optional<ModelLibrary> library_;
};

}  // namespace hapsim
