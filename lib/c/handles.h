// What the handles of hapsim.h are, and how a call of C becomes one of C++.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "c/hapsim.h"
#include "cli/failure.h"
#include "mesh/tetmesh.h"
#include "model/model.h"
#include "recording/recording.h"

struct hs_body {
  std::string name;
  hapsim::TetMesh mesh;
  std::vector<hapsim::Vec3> window;
};

struct hs_recording {
  hapsim::Recording recording;
  std::map<std::string, std::vector<double>> extra;  // unknown columns that were asked for
};

struct hs_model {
  hapsim::Model model;
  std::string text;  // hs_model_text()
};

namespace hapsim {

// Keeps what hs_message() says.
hs_status tell_failure(const Failure& failure) noexcept;

// Runs `body`; what it throws becomes the status.
template <class Body>
hs_status guarded(const Body& body) noexcept {
  try {
    body();
    return HS_DONE;
  } catch (...) {
    return tell_failure(current_failure());
  }
}

// The same, where `body` returns what `*out` gets: a unique_ptr, of which nothing is left
// otherwise.
template <class Handle, class Body>
hs_status made(Handle** out, const Body& body) noexcept {
  *out = nullptr;
  return guarded([&] { *out = body().release(); });
}

std::unique_ptr<hs_recording> handle_of(Recording recording);
std::unique_ptr<hs_model> handle_of(Model model);

// The value of the last line with that key, where it stands; null where there is none.
const char* find_text(const Metadata& metadata, const char* key) noexcept;
const char* key_text(const Metadata& metadata, std::size_t number) noexcept;

}  // namespace hapsim
