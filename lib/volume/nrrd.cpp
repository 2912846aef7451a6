#include <teem/nrrd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <memory>

#include "base/error.h"
#include "io/number.h"
#include "volume/gunzip.h"
#include "volume/volume.h"

namespace hapsim {
namespace {

struct Nuke {
  void operator()(Nrrd* nrrd) const { nrrdNuke(nrrd); }
  void operator()(NrrdIoState* state) const { nrrdIoStateNix(state); }
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// The innermost complaint of the library, without its function names.
std::string complaint() {
  char* text = biffGetDone(nrrdBiffKey);
  std::string all = text == nullptr ? "" : text;
  std::free(text);
  while (!all.empty() && all.back() == '\n') all.pop_back();
  std::string last = all.substr(all.rfind('\n') == std::string::npos ? 0 : all.rfind('\n') + 1);
  const std::size_t colon = last.find(": ");
  if (colon != std::string::npos) last = last.substr(colon + 2);
  return last.empty() ? "it is no valid NRRD" : last;
}

// Before the library sees it: it would open the file that the field names, whichever that is. A
// carriage return ends a line for it too.
void refuse_other_files(const std::string& bytes, const std::string& name) {
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find_first_of("\r\n", at), bytes.size());
    std::string field;
    for (std::size_t i = at; i < end && bytes[i] != ':'; ++i)
      if (bytes[i] != ' ' && bytes[i] != '\t')
        field += static_cast<char>(std::tolower(static_cast<unsigned char>(bytes[i])));
    if (field == "datafile")
      fail_input(name, "header and voxels are in two files", "join them: unu save -f nrrd");
    if (end + 1 < bytes.size() && bytes[end] == '\n' &&
        (bytes[end + 1] == '\n' || bytes.compare(end + 1, 2, "\r\n") == 0))
      return;  // an empty line ends the header
    at = end + 1;
  }
}

// Reads header, or header and voxels, from memory.
std::unique_ptr<Nrrd, Nuke> load(const std::string& bytes, const std::string& name, bool voxels,
                                 std::unique_ptr<NrrdIoState, Nuke>& state) {
  nrrdStateVerboseIO = 0;
  const std::unique_ptr<std::FILE, Nuke> file(
      fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb"));
  if (!file) fail_numerics(name, "there is no memory to read it", "use a smaller file");
  std::unique_ptr<Nrrd, Nuke> nrrd(nrrdNew());
  state.reset(nrrdIoStateNew());
  state->skipData = voxels ? 0 : 1;
  if (nrrdRead(nrrd.get(), file.get(), state.get()) != 0) {
    fail_input(name, "cannot be read as NRRD: " + complaint(), "copy or export it again");
  }
  return nrrd;
}

double factor_of(const char* unit) {
  const std::string text = unit == nullptr ? "" : unit;
  if (text == "m" || text == "meter") return 1;
  if (text == "cm") return 1e-2;
  if (text == "um" || text == "micron" || text == "µm") return 1e-6;
  return 1e-3;
}

void take_world(const Nrrd& nrrd, const std::array<unsigned, 3>& axes, Volume& volume) {
  bool stated = false;
  for (int c = 0; c < 3; ++c) {
    const NrrdAxisInfo& axis = nrrd.axis[axes[static_cast<std::size_t>(c)]];
    const bool direction = nrrd.spaceDim == 3 && std::isfinite(axis.spaceDirection[0]);
    for (int r = 0; r < 3; ++r) {
      const double unit =
          factor_of(nrrd.spaceUnits[r] != nullptr ? nrrd.spaceUnits[r] : axis.units);
      stated = stated || nrrd.spaceUnits[r] != nullptr || axis.units != nullptr;
      double m = 0;
      if (direction) {
        m = axis.spaceDirection[r];
      } else if (r == c) {
        m = std::isfinite(axis.spacing) ? axis.spacing : 1;
      }
      volume.to_world.matrix()(r, c) = unit * m;
      double origin = nrrd.spaceDim == 3 ? nrrd.spaceOrigin[r] : NAN;
      if (!std::isfinite(origin))
        origin = !direction && std::isfinite(axis.min) && r == c ? axis.min : NAN;
      if (std::isfinite(origin)) volume.to_world.matrix()(r, 3) = unit * origin;
    }
  }
  if (!stated) volume.notes.push_back("no unit stated, taken for mm");
}

}  // namespace

Volume read_nrrd(const std::string& bytes, const std::string& name) {
  refuse_other_files(bytes, name);
  std::unique_ptr<NrrdIoState, Nuke> state;
  const auto header = load(bytes, name, false, state);
  if (state->detachedHeader != 0) {
    fail_input(name, "header and voxels are in two files", "join them: unu save -f nrrd");
  }
  std::array<unsigned, 3> axes{};
  int used = 0;
  for (unsigned a = 0; a < header->dim; ++a) {
    if (header->axis[a].size == 1) continue;
    if (used < 3) axes[static_cast<std::size_t>(used)] = a;
    ++used;
  }
  if (used != 3) {
    fail_input(name, "it has " + std::to_string(used) + " axes, not 3", "extract one volume of it");
  }
  if (header->type == nrrdTypeBlock || header->type == nrrdTypeUnknown) {
    fail_input(name, "its voxels are no numbers", "convert them to float");
  }
  const bool ascii = state->encoding == nrrdEncodingAscii, hex = state->encoding == nrrdEncodingHex;
  const bool raw = state->encoding == nrrdEncodingRaw, zip = state->encoding == nrrdEncodingGzip;
  if (!ascii && !hex && !raw && !zip) {
    fail_input(name, std::string("its encoding is ") + state->encoding->name,
               "write it as gzip: unu save -f nrrd -e gzip");
  }
  const double element = static_cast<double>(nrrdElementSize(header.get()));
  const double voxel = ascii ? 2 : hex ? 2 * element : element;
  Volume volume;
  volume.format = std::string("NRRD, ") + state->encoding->name;
  allocate_volume(volume,
                  {static_cast<long long>(header->axis[axes[0]].size),
                   static_cast<long long>(header->axis[axes[1]].size),
                   static_cast<long long>(header->axis[axes[2]].size)},
                  voxel, (static_cast<double>(bytes.size()) + 1) * (zip ? kMostGzipRatio : 1),
                  name);
  take_world(*header, axes, volume);
  check_world(volume, name);

  const auto whole = load(bytes, name, true, state);
  if (nrrdElementNumber(whole.get()) != volume.count()) {
    fail_input(name, "its voxels are not as many as its sizes say", "export it again");
  }
  float (*lookup)(const void*, size_t) = nrrdFLookup[whole->type];
  for (std::size_t i = 0; i < volume.count(); ++i) volume.values[i] = lookup(whole->data, i);
  return volume;
}

}  // namespace hapsim
