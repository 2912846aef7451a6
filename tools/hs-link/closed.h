// The closed link of hs-link: its key, what both sides must agree on, and who may be spoken to.
#pragma once

#include <sstream>

#include "base/error.h"
#include "common_options.h"
#include "hs-link/flags.h"
#include "link/ends.h"
#include "link/key_file.h"
#include "model/model.h"

namespace hapsim {

// The key of --key. Without one, and without --insecure, only this machine is spoken to.
inline Secret link_key(const Arguments& arguments, const UdpAddress& address) {
  if (arguments.given(flag::key)) {
    if (arguments[flag::insecure])
      fail_usage("--key and --insecure exclude each other", "leave one of them out");
    return read_key(arguments[flag::key]);
  }
  if (!address.is_loopback() && !arguments[flag::insecure])
    fail_usage(to_text(address) + " is not this machine, and there is no key",
               "give both sides the same --key FILE (hs-link --make-key FILE), or --insecure where "
               "nobody else is on the network");
  return public_key();
}

inline Fingerprint fingerprint_of(const Model& model) {
  Model plain = model;
  plain.metadata = {};
  std::ostringstream text;
  write_model(text, plain);
  const std::string bytes = text.str();
  return fingerprint_of(Bytes(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

inline Terms link_terms(const TetMesh& body, double tool_radius) {
  Terms terms;
  terms.tool_radius = tool_radius;
  terms.low = terms.high = body.nodes.front();
  for (const Vec3& node : body.nodes) {
    terms.low = terms.low.cwiseMin(node);
    terms.high = terms.high.cwiseMax(node);
  }
  terms.body = fingerprint_of(Bytes(reinterpret_cast<const unsigned char*>(body.nodes.data()),
                                    body.nodes.size() * sizeof(Vec3)));
  return terms;
}

}  // namespace hapsim
