#include "realtime/stiffness_field.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "contact/contact_cache.h"
#include "realtime/insert_vertex.h"

namespace hapsim {
namespace {

constexpr int kMostSteps = 64;
// Relative change between entries that is taken as straight: of what the samples leave unknown, a
// quarter, but not below the least.
constexpr double kStraight = 0.004, kStraightShare = 0.25;
constexpr double kClosest = 0.15;    // entries are not closer than this, in tool radii
constexpr std::size_t kBlock = 256;  // places estimated at a time

constexpr std::size_t kNumbers = 14;  // of an entry in a file

constexpr char kMagic[8] = {'h', 's', 'f', 'i', 'e', 'l', '0', '1'};

// Row i of `steps`, place j of i: corner 0 is row 0, row `steps` runs from corner 1 to corner 2.
int lattice_index(int i, int j) {
  return i * (i + 1) / 2 + j;
}

Vec3 lattice_point(const Surface& surface, const Triangle& t, int steps, int i, int j) {
  const double w = 1.0 / steps;
  return surface.vertices[t[0]] + w * (i - j) * (surface.vertices[t[1]] - surface.vertices[t[0]]) +
         w * j * (surface.vertices[t[2]] - surface.vertices[t[0]]);
}

double longest_edge(const Surface& surface, const Triangle& t) {
  double longest = 0;
  for (int k = 0; k < 3; ++k)
    longest = std::max(longest, (surface.vertices[t[k]] - surface.vertices[t[(k + 1) % 3]]).norm());
  return longest;
}

double size_of(const Surface& surface) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : surface.vertices) box.extend(p);
  return box.diagonal().norm();
}

std::vector<int> insert_known(Surface& surface, const std::vector<KnownStiffness>& known) {
  const double size = size_of(surface);
  std::vector<int> vertices;
  for (const KnownStiffness& contact : known) {
    const SurfacePoint place = nearest_point(surface, contact.point);
    const std::string where = fmt::format("contact at ({:.6g}, {:.6g}, {:.6g})", contact.point.x(),
                                          contact.point.y(), contact.point.z());
    if (place.distance > 0.1 * size)
      fail_input(where, "it lies far off the body's surface", "check the frame and the unit");
    if (Eigen::LLT<Eigen::Matrix3d>(contact.K).info() != Eigen::Success)
      fail_input(where, "its stiffness is not positive definite", "prepare it again");
    vertices.push_back(insert_vertex(surface, place.face, place.point));
  }
  return vertices;
}

// Entries by place, each estimated once.
class EntryTable {
 public:
  EntryTable(const FieldSampling& sampling, double grain, int threads)
      : sampling_(sampling), grain_(grain), threads_(threads) {}

  int index(const Vec3& p) {
    std::array<long, 3> key;
    for (int k = 0; k < 3; ++k) key[k] = std::lround(p[k] / grain_);
    const auto [place, fresh] = known_.try_emplace(key, static_cast<int>(entries_.size()));
    if (fresh) {
      FieldEntry entry;
      entry.point = p;
      entries_.push_back(entry);
    }
    return place->second;
  }
  // Those that were named since it was last asked.
  void estimate() {
    const std::size_t begin = done_, count = entries_.size() - begin;
    in_parallel((count + kBlock - 1) / kBlock, threads_, [&](std::size_t block) {
      const std::size_t first = begin + block * kBlock,
                        last = std::min(first + kBlock, entries_.size());
      std::vector<PlaceView> views;
      for (std::size_t i = first; i < last; ++i)
        views.push_back(sampling_.views().at(entries_[i].point));
      const std::vector<PlaceEstimate> estimates = sampling_.model().at(views, true);
      for (std::size_t i = first; i < last; ++i) {
        entries_[i].K = estimates[i - first].K;
        entries_[i].uncertainty = estimates[i - first].uncertainty;
        entries_[i].sampled = sampling_.is_touchable(entries_[i].point);
      }
    });
    done_ = entries_.size();
  }
  const Eigen::Matrix3d& K(int entry) const { return entries_[static_cast<std::size_t>(entry)].K; }
  std::vector<FieldEntry>& entries() { return entries_; }

 private:
  const FieldSampling& sampling_;
  double grain_;
  int threads_;
  std::map<std::array<long, 3>, int> known_;
  std::vector<FieldEntry> entries_;
  std::size_t done_ = 0;
};

// No overload of another file of the room may take a type: the room is compiled whole.
template <class T>
void put_one(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
void put_all(std::string& bytes, const std::vector<T>& values) {
  put_one(bytes, static_cast<std::uint64_t>(values.size()));
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

class Take {
 public:
  explicit Take(const std::string& bytes) : bytes_(bytes) {}
  template <class T>
  void one(T& value) {
    copy(&value, sizeof value);
  }
  template <class T>
  void all(std::vector<T>& values) {
    std::uint64_t count = 0;
    one(count);
    if (count > (bytes_.size() - at_) / sizeof(T)) fail();
    values.resize(count);
    copy(values.data(), count * sizeof(T));
  }
  bool at_end() const { return at_ == bytes_.size(); }
  [[noreturn]] static void fail() {
    fail_input("", "a prepared stiffness field is damaged or of another layout",
               "remove it, so that it is made again");
  }

 private:
  void copy(void* to, std::size_t count) {
    if (count > bytes_.size() - at_) fail();
    std::memcpy(to, bytes_.data() + at_, count);
    at_ += count;
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
};

std::string sum_of(const std::string& bytes) {
  ContentHash hash;
  hash.add(bytes);
  return hash.hex();
}

}  // namespace

StiffnessField::StiffnessField(const Surface& surface, const FieldSampling& sampling,
                               const std::vector<KnownStiffness>& known, double tool_radius,
                               int threads)
    : surface_(surface), samples_(sampling.samples()), expected_(sampling.expected_error()) {
  const double straight_within = std::max(kStraight, kStraightShare * expected_);
  const std::vector<int> known_vertex = insert_known(surface_, known);
  const double size = size_of(surface_);
  EntryTable table(sampling, 1e-8 * size, threads);
  const std::size_t faces = surface_.faces.size();
  steps_.assign(faces, 1);
  std::vector<std::vector<int>> lattice(faces);
  std::vector<std::size_t> open;
  const auto lay = [&](std::size_t f, int steps) {
    std::vector<int> entries;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= i; ++j)
        entries.push_back(table.index(lattice_point(surface_, surface_.faces[f], steps, i, j)));
    return entries;
  };
  for (std::size_t f = 0; f < faces; ++f) {
    lattice[f] = lay(f, 1);
    open.push_back(f);
  }
  table.estimate();
  while (!open.empty()) {
    std::vector<std::size_t> tried;
    std::vector<std::vector<int>> finer;
    for (const std::size_t f : open)
      if (steps_[f] < kMostSteps &&
          longest_edge(surface_, surface_.faces[f]) > 2 * steps_[f] * kClosest * tool_radius) {
        tried.push_back(f);
        finer.push_back(lay(f, 2 * steps_[f]));
      }
    table.estimate();
    open.clear();
    for (std::size_t k = 0; k < tried.size(); ++k) {
      const std::size_t f = tried[k];
      double worst = 0;
      for (int i = 0; i <= 2 * steps_[f]; ++i)
        for (int j = 0; j <= i; ++j) {
          if (i % 2 == 0 && j % 2 == 0) continue;
          // The middle of two entries of the present lattice.
          const int i1 = i / 2, i2 = (i + 1) / 2, j1 = j / 2, j2 = (j + 1) / 2;
          const Eigen::Matrix3d straight =
              0.5 * (table.K(lattice[f][static_cast<std::size_t>(lattice_index(i1, j1))]) +
                     table.K(lattice[f][static_cast<std::size_t>(lattice_index(i2, j2))]));
          const Eigen::Matrix3d& K =
              table.K(finer[k][static_cast<std::size_t>(lattice_index(i, j))]);
          worst = std::max(worst, (K - straight).norm() / K.norm());
        }
      if (worst <= straight_within) continue;
      steps_[f] *= 2;
      lattice[f] = std::move(finer[k]);
      open.push_back(f);
    }
  }
  for (const std::vector<int>& entries : lattice) {
    first_.push_back(static_cast<int>(lattice_.size()));
    lattice_.insert(lattice_.end(), entries.begin(), entries.end());
  }
  // Only what a lattice names stays.
  std::vector<int> place(table.entries().size(), -1);
  for (int& entry : lattice_) {
    int& now = place[static_cast<std::size_t>(entry)];
    if (now < 0) {
      now = static_cast<int>(entries_.size());
      entries_.push_back(table.entries()[static_cast<std::size_t>(entry)]);
      double& doubt = entries_.back().uncertainty;  // half the worst between entries is usual there
      doubt = std::hypot(doubt, straight_within / 2);
    }
    entry = now;
  }
  for (std::size_t k = 0; k < known.size(); ++k) {
    const Vec3& p = surface_.vertices[static_cast<std::size_t>(known_vertex[k])];
    known_.push_back(place[static_cast<std::size_t>(table.index(p))]);
    FieldEntry& entry = entries_[static_cast<std::size_t>(known_.back())];
    entry.K = 0.5 * (known[k].K + known[k].K.transpose());
    entry.uncertainty = 0;
    entry.sampled = true;
  }
}

StiffnessField::StiffnessField(const std::string& bytes) {
  if (bytes.size() < 32 ||
      sum_of(bytes.substr(0, bytes.size() - 32)) != bytes.substr(bytes.size() - 32))
    Take::fail();
  const std::string body = bytes.substr(0, bytes.size() - 32);
  Take take(body);
  char magic[8];
  take.one(magic);
  if (std::memcmp(magic, kMagic, sizeof magic) != 0) Take::fail();
  take.all(surface_.vertices);
  take.all(surface_.faces);
  take.all(first_);
  take.all(steps_);
  take.all(lattice_);
  std::vector<double> numbers;
  take.all(numbers);
  for (std::size_t i = 0; i + kNumbers <= numbers.size(); i += kNumbers) {
    FieldEntry entry;
    entry.point = Eigen::Map<const Vec3>(&numbers[i]);
    entry.K = Eigen::Map<const Eigen::Matrix3d>(&numbers[i + 3]);
    entry.uncertainty = numbers[i + 12];
    entry.sampled = numbers[i + 13] != 0;
    entries_.push_back(entry);
  }
  take.all(known_);
  std::uint64_t samples = 0;
  take.one(samples);
  samples_ = samples;
  take.one(expected_);
  if (!take.at_end()) Take::fail();
}

std::string StiffnessField::bytes() const {
  std::string bytes;
  bytes.append(kMagic, sizeof kMagic);
  put_all(bytes, surface_.vertices);
  put_all(bytes, surface_.faces);
  put_all(bytes, first_);
  put_all(bytes, steps_);
  put_all(bytes, lattice_);
  std::vector<double> numbers;
  for (const FieldEntry& entry : entries_) {
    numbers.insert(numbers.end(), entry.point.begin(), entry.point.end());
    numbers.insert(numbers.end(), entry.K.data(), entry.K.data() + 9);
    numbers.push_back(entry.uncertainty);
    numbers.push_back(entry.sampled ? 1 : 0);
  }
  put_all(bytes, numbers);
  put_all(bytes, known_);
  put_one(bytes, static_cast<std::uint64_t>(samples_));
  put_one(bytes, expected_);
  return bytes + sum_of(bytes);
}

void StiffnessField::scale(const std::function<double(const Vec3&)>& factor) {
  for (FieldEntry& entry : entries_) entry.K *= factor(entry.point);
}

StiffnessField::Place StiffnessField::locate(int face, const Vec3& point) const noexcept {
  const Triangle& t = surface_.faces[face];
  Vec3 weight = corner_weights(point, surface_.vertices[t[0]], surface_.vertices[t[1]],
                               surface_.vertices[t[2]])
                    .cwiseMax(0.0);
  weight /= weight.sum();
  const int steps = steps_[face], first = first_[face];
  // In lattice steps from corner 0: a towards corner 1, b towards corner 2; row i = a + b.
  const double a = steps * weight[1], b = steps * weight[2];
  const int row = std::min(static_cast<int>(a + b), steps - 1);
  const int column = std::clamp(static_cast<int>(b), 0, row);
  const double down = a + b - row;  // of the way to the next row
  const double right = b - column;
  Place place;
  if (right <= down) {  // (row, column), (row + 1, column), (row + 1, column + 1)
    place.entry = {lattice_[first + lattice_index(row, column)],
                   lattice_[first + lattice_index(row + 1, column)],
                   lattice_[first + lattice_index(row + 1, column + 1)]};
    place.weight = {1 - down, down - right, right};
  } else {  // (row, column), (row, column + 1), (row + 1, column + 1)
    place.entry = {lattice_[first + lattice_index(row, column)],
                   lattice_[first + lattice_index(row, std::min(column + 1, row))],
                   lattice_[first + lattice_index(row + 1, column + 1)]};
    place.weight = {1 - right, right - down, down};
  }
  place.weight = place.weight.cwiseMax(0.0);
  place.weight /= place.weight.sum();
  return place;
}

Eigen::Matrix3d StiffnessField::at(const Place& place) const noexcept {
  return place.weight[0] * entries_[place.entry[0]].K +
         place.weight[1] * entries_[place.entry[1]].K +
         place.weight[2] * entries_[place.entry[2]].K;
}

FieldEntry StiffnessField::entry_at(const Place& place) const noexcept {
  FieldEntry result;
  result.point.setZero();
  result.K = at(place);
  result.sampled = true;
  for (int k = 0; k < 3; ++k) {
    const FieldEntry& entry = entries_[place.entry[k]];
    result.point += place.weight[k] * entry.point;
    result.uncertainty += place.weight[k] * entry.uncertainty;
    result.sampled = result.sampled && (entry.sampled || place.weight[k] < 1e-12);
  }
  return result;
}

}  // namespace hapsim
