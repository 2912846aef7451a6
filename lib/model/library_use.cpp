#include "model/library_use.h"

#include <filesystem>

#include "io/stream.h"

namespace hapsim {

LibraryUse::LibraryUse(const std::string& path, const Described& described,
                       std::function<void(const std::string&)> say)
    : path_(path), described_(described), say_(std::move(say)) {
  if (std::filesystem::exists(path_)) {
    open();
  } else {
    const Output may_be_made(path_);
  }
}

void LibraryUse::add_start(std::vector<Model>& starts) {
  std::vector<LibraryEntry> entries;
  if (library_) entries = library_->entries();
  const LibraryEntry* nearest = nearest_entry(entries, described_, starts.front().effects());
  if (nearest == nullptr) return tell("it has no entry yet: the usual start");
  const bool same_object =
      !nearest->described.object.empty() && nearest->described.object == described_.object;
  const auto start = with_values_of(starts.front(), nearest->model, same_object);
  if (!start) return tell("nothing to start from in the nearest, " + words_of(*nearest));
  starts.push_back(*start);
  tell("start values from the nearest, " + words_of(*nearest));
}

void LibraryUse::store(const Model& model, const std::function<void()>& commit) {
  if (!library_) open();
  Database::Transaction transaction(library_->database());
  const int id = library_->add(described_, model);
  commit();
  transaction.commit();
  tell("stored as entry " + std::to_string(id));
}

}  // namespace hapsim
