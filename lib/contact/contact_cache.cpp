#include "contact/contact_cache.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "io/stream.h"

namespace hapsim {
namespace fs = std::filesystem;
namespace {

// Begins every entry; a new layout, meshing or mixture gets a new number.
constexpr char kMagic[8] = {'h', 's', 'c', 'o', 'n', 't', '1', '4'};

struct Head {
  char magic[8];
  std::uint64_t groups, cells, features;
};

constexpr std::uint64_t kMostFeatures = 64, kMostValues = 64;

void append(std::string& bytes, const void* data, std::size_t count) {
  bytes.append(static_cast<const char*>(data), count);
}

// Ends every entry: a damaged one must not become a result.
std::string sum_of(const std::string& bytes) {
  ContentHash hash;
  hash.add(bytes);
  return hash.hex();
}

}  // namespace

void ContentHash::add(const void* bytes, std::size_t count) {
  const auto* p = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < count; ++i) {
    a_ = (a_ ^ p[i]) * 1099511628211ull;
    b_ = (b_ + p[i]) * 0xff51afd7ed558ccdull;
    b_ ^= b_ >> 29;
  }
}

std::string ContentHash::hex() const {
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(a_),
                static_cast<unsigned long long>(b_));
  return text;
}

ContactCache::ContactCache(const std::string& directory, double limit_bytes)
    : limit_bytes_(limit_bytes) {
  if (directory.empty()) return;
  std::error_code failed;
  fs::create_directories(directory, failed);
  if (failed) return;
  directory_ = directory;
}

std::optional<StiffnessSolution> ContactCache::load(const std::string& key) const {
  if (directory_.empty()) return std::nullopt;
  std::ifstream entry(fs::path(directory_) / (key + ".contact"), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(entry), {}};
  constexpr std::size_t kSum = 32;
  if (bytes.size() < kSum) return std::nullopt;
  const std::string sum = bytes.substr(bytes.size() - kSum);
  bytes.resize(bytes.size() - kSum);
  if (sum_of(bytes) != sum) return std::nullopt;
  std::istringstream file(bytes);
  Head head;
  if (!file.read(reinterpret_cast<char*>(&head), sizeof head) ||
      std::memcmp(head.magic, kMagic, sizeof kMagic) != 0 || head.groups > 100000 ||
      head.cells > 1000000 || head.features > kMostFeatures)
    return std::nullopt;
  StiffnessSolution s;
  const auto read = [&](void* data, std::size_t count) {
    file.read(static_cast<char*>(data), static_cast<std::streamsize>(count));
  };
  read(s.K.data(), sizeof s.K);
  read(s.dK_dnu.data(), sizeof s.dK_dnu);
  read(s.coarse_change.data(), sizeof s.coarse_change);
  read(s.coarse_dK_dnu.data(), sizeof s.coarse_dK_dnu);
  read(s.mixed.data(), sizeof s.mixed);
  read(s.point.data(), sizeof s.point);
  read(s.normal.data(), sizeof s.normal);
  s.dK_dmodulus.resize(head.groups);
  for (auto& k : s.dK_dmodulus) read(k.data(), sizeof k);
  s.plan_share.resize(head.cells);
  read(s.plan_share.data(), head.cells * sizeof(float));
  for (std::uint64_t f = 0; f < head.features; ++f) {
    std::uint64_t values = 0;
    read(&values, sizeof values);
    if (!file || values > kMostValues) return std::nullopt;
    s.dK_dfeature.emplace_back(values);
    for (auto& k : s.dK_dfeature.back()) read(k.data(), sizeof k);
  }
  // An entry of another length was written with another layout.
  if (!file || file.peek() != std::istringstream::traits_type::eof()) return std::nullopt;
  return s;
}

void ContactCache::store(const std::string& key, const StiffnessSolution& s) const {
  if (directory_.empty()) return;
  std::call_once(*trimmed_, [this] { trim(); });
  std::string bytes;
  Head head{{}, s.dK_dmodulus.size(), s.plan_share.size(), s.dK_dfeature.size()};
  std::memcpy(head.magic, kMagic, sizeof kMagic);
  append(bytes, &head, sizeof head);
  append(bytes, s.K.data(), sizeof s.K);
  append(bytes, s.dK_dnu.data(), sizeof s.dK_dnu);
  append(bytes, s.coarse_change.data(), sizeof s.coarse_change);
  append(bytes, s.coarse_dK_dnu.data(), sizeof s.coarse_dK_dnu);
  append(bytes, s.mixed.data(), sizeof s.mixed);
  append(bytes, s.point.data(), sizeof s.point);
  append(bytes, s.normal.data(), sizeof s.normal);
  for (const auto& k : s.dK_dmodulus) append(bytes, k.data(), sizeof k);
  append(bytes, s.plan_share.data(), s.plan_share.size() * sizeof(float));
  for (const auto& feature : s.dK_dfeature) {
    const std::uint64_t values = feature.size();
    append(bytes, &values, sizeof values);
    for (const auto& k : feature) append(bytes, k.data(), sizeof k);
  }
  try {
    Output file((fs::path(directory_) / (key + ".contact")).string());
    file.write(bytes + sum_of(bytes));
    file.commit();
  } catch (const Error&) {
    // A full or read-only cache costs time, not the result.
  }
}

void ContactCache::trim() const {
  struct Entry {
    fs::file_time_type time;
    double size;
    fs::path path;
  };
  std::vector<Entry> entries;
  double total = 0;
  std::error_code ignored;
  for (const auto& item : fs::directory_iterator(directory_, ignored)) {
    const fs::path kind = item.path().extension();
    if (kind != ".contact" && kind != ".field" && kind != ".strain") continue;
    Entry entry{item.last_write_time(ignored), static_cast<double>(item.file_size(ignored)),
                item.path()};
    total += entry.size;
    entries.push_back(entry);
  }
  if (total <= limit_bytes_) return;
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.time < b.time; });
  for (const Entry& entry : entries) {
    if (total <= 0.8 * limit_bytes_) break;
    fs::remove(entry.path, ignored);
    total -= entry.size;
  }
}

std::string default_cache_directory() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0')
    return std::string(cache) + "/hapsim";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
    return std::string(home) + "/.cache/hapsim";
  return "";
}

}  // namespace hapsim
