#include "import/column_synonyms.h"

#include <algorithm>
#include <initializer_list>

namespace hapsim {
namespace {

using Words = std::initializer_list<const char*>;

bool is_one_of(const std::string& name, Words words) {
  return std::find(words.begin(), words.end(), name) != words.end();
}

bool holds(const std::string& name, Words words) {
  return std::any_of(words.begin(), words.end(),
                     [&name](const char* word) { return name.find(word) != name.npos; });
}

// Position of the first word that the name holds, counted from `rank`; -1 when there is none.
int rank_of(const std::string& name, Words words, int rank) {
  for (const char* word : words) {
    if (name.find(word) != name.npos) return rank;
    ++rank;
  }
  return -1;
}

}  // namespace

VectorRole vector_role(const std::string& b) {
  if (b.size() > 2 && b[1] == ':') {
    const VectorRole role = vector_role(b.substr(0, 1));
    const std::string rest = b.substr(2);
    if (role == VectorRole::kForce) return holds(rest, {"contact"}) ? VectorRole::kCount : role;
    return role == VectorRole::kNormal || role == VectorRole::kDisplacement ? role
                                                                            : vector_role(rest);
  }
  if (holds(b, {"torque", "moment", "velocity", "speed", "accel", "target", "quat", "angle"}))
    return VectorRole::kCount;
  const bool force = is_one_of(b, {"f", "ft"}) || holds(b, {"force", "kraft", "load", "wrench"});
  // The small force at which contact was declared is no recording.
  if (force)
    return holds(b, {"contactforce", "kontaktkraft"}) ? VectorRole::kCount : VectorRole::kForce;
  if (is_one_of(b, {"n", "nrm"}) || holds(b, {"norm", "outward"})) return VectorRole::kNormal;
  if (is_one_of(b, {"u", "d", "du", "delta"}) || holds(b, {"displ", "deflect", "verschieb"}))
    return VectorRole::kDisplacement;
  if (is_one_of(b, {"des", "cmd"}) || holds(b, {"desired", "command", "soll", "setpoint", "goal"}))
    return VectorRole::kDesired;
  if (holds(b, {"deform"})) return VectorRole::kDeformed;
  if (holds(b, {"contact", "kontakt", "touch"}) && holds(b, {"ball", "center", "centre", "tip"}))
    return VectorRole::kContactBall;
  if (is_one_of(b, {"c", "cp", "p0", "x0", "origin", "site", "s"}) ||
      holds(b, {"contact", "kontakt", "surface", "touch", "oberflaeche"}))
    return VectorRole::kContact;
  if (holds(b, {"ref"})) return VectorRole::kCount;
  if (b.empty() || is_one_of(b, {"p", "pos", "position", "point", "coord", "xyz", "koordinate"}))
    return VectorRole::kPlain;
  if (holds(b, {"tip", "current", "actual", "tool", "tcp", "effector", "probe", "ball", "indenter",
                "position", "pos", "spitze", "ist"}) ||
      is_one_of(b, {"ee", "cur", "act", "meas", "measured"}))
    return VectorRole::kTip;
  return VectorRole::kCount;
}

ScalarMatch scalar_role(const std::string& name, UnitKind unit) {
  const auto fits = [unit](UnitKind kind) { return unit == UnitKind::kNone || unit == kind; };
  const bool extreme =
      holds(name, {"max", "min", "mean", "limit", "rate", "speed", "strain", "stress", "stiff"});
  if (extreme) return {};
  if (fits(UnitKind::kTemperature) &&
      (unit == UnitKind::kTemperature || holds(name, {"temperatur"}) ||
       is_one_of(name, {"temp", "tempc"})))
    return {ScalarRole::kTemperature, 0};
  if (fits(UnitKind::kTime) && !holds(name, {"completion", "date"})) {
    if (is_one_of(name, {"t", "time", "zeit"})) return {ScalarRole::kTime, 0};
    const int rank =
        rank_of(name, {"testtime", "pruefzeit", "time", "zeit", "elapsed", "seconds"}, 1);
    if (rank >= 0) return {ScalarRole::kTime, rank};
  }
  if (is_one_of(name, {"contact", "incontact"})) return {ScalarRole::kContactFlag, 0};
  if (is_one_of(name, {"fail", "failed", "failure", "invalid"})) return {ScalarRole::kFail, 0};
  if (is_one_of(name, {"depthindex", "depthid", "depthno", "depthnr", "depthstep", "depthlevel",
                       "step", "level", "sample", "sampleindex", "k", "row", "frame", "depthidx",
                       "idepth", "kdepth"}))
    return {ScalarRole::kSample, 0};
  if (fits(UnitKind::kForce) &&
      !holds(name, {"preload", "vorkraft", "tare", "noise", "contactforce"})) {
    if (is_one_of(name, {"fn", "fnormal", "normalforce", "forcenormal", "forcen"}))
      return {ScalarRole::kForce, 0};
    if (is_one_of(name, {"f", "force", "kraft", "load", "last"})) return {ScalarRole::kForce, 1};
    const int rank = rank_of(
        name, {"standardforce", "standardkraft", "pruefkraft", "force", "kraft", "load", "fmag"},
        2);
    if (rank >= 0) return {ScalarRole::kForce, rank};
  }
  if (fits(UnitKind::kLength)) {
    const int rank =
        rank_of(name,
                {"indentation", "eindring", "penetration", "depth", "tiefe", "standardtravel",
                 "standardweg", "travel", "weg", "displ", "crosshead", "traverse", "stroke",
                 "extension", "deform", "verform", "compression", "stauchung", "extensometer"},
                0);
    if (rank >= 0)
      return {ScalarRole::kDepth,
              rank + (holds(name, {"desired", "command", "cmd", "nominal", "soll"}) ? 15 : 0)};
    if (is_one_of(name, {"d", "h", "s", "u"})) return {ScalarRole::kDepth, 30};
    if (is_one_of(name, {"position", "pos", "z", "uz"})) return {ScalarRole::kDepth, 31};
  }
  return {};
}

PressWord press_word(const std::string& name) {
  if (is_one_of(
          name,
          {"press",     "pressid", "site",      "siteid",     "siteindex",  "siteno", "sitenr",
           "siteidx",   "probing", "probingid", "trial",      "run",        "indent", "indentid",
           "palpation", "episode", "location",  "locationid", "repetition", "cycle",  "zyklus"}))
    return PressWord::kYes;
  if (is_one_of(name, {"test",          "testid",   "testno",       "recording",     "recordingid",
                       "recordingname", "specimen", "specimenid",   "specimenno",    "messung",
                       "versuch",       "pruefung", "probennummer", "probe",         "probeid",
                       "file",          "filename", "measurement",  "measurementid", "experiment",
                       "region",        "organ",    "curve",        "kurve",         "serie",
                       "series",        "sampleid", "samplename"}))
    return PressWord::kGroup;
  if (is_one_of(name,
                {"point", "pointid", "pointindex", "pointno", "pointidx", "index", "idx", "id", "i",
                 "j", "n", "nr", "no", "number", "num", "position", "pos", "sample", "samples"}))
    return PressWord::kPerhaps;
  return PressWord::kNo;
}

bool is_travel(const std::string& name) {
  return !holds(name, {"indent", "penetr", "depth", "eindring", "tiefe"});
}

}  // namespace hapsim
