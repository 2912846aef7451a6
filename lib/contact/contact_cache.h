// Prepared stiffnesses on disk, by content: safe for many processes at once and safe to delete.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "contact/contact_stiffness.h"

namespace hapsim {

// A 128-bit content hash (two FNV-1a streams), enough to name cache entries.
class ContentHash {
 public:
  void add(const void* bytes, std::size_t count);
  void add(double value) { add(&value, sizeof value); }
  void add(const std::string& text) { add(text.data(), text.size()); }
  std::string hex() const;

 private:
  std::uint64_t a_ = 14695981039346656037ull;
  std::uint64_t b_ = 0x9ae16a3b2f90404full;
};

class ContactCache {
 public:
  // `directory` empty: no cache. Created on first use; when it cannot be written, caching is
  // silently off, for no result depends on it. Before the first entry is stored, those beyond
  // `limit_bytes` are removed, oldest first: who only reads need not look at them all.
  explicit ContactCache(const std::string& directory, double limit_bytes = 1e9);
  // Nothing for an entry that is absent, damaged or of another layout.
  std::optional<StiffnessSolution> load(const std::string& key) const;
  void store(const std::string& key, const StiffnessSolution& solution) const;

 private:
  void trim() const;
  std::string directory_;
  double limit_bytes_;
  std::shared_ptr<std::once_flag> trimmed_ = std::make_shared<std::once_flag>();
};

// $XDG_CACHE_HOME/hapsim, else $HOME/.cache/hapsim, else none.
std::string default_cache_directory();

}  // namespace hapsim
