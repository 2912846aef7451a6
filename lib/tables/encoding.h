// Encodings of text, found or told: machines export UTF-16, code pages of Windows, Chinese and
// Japanese ones and UTF-8 alike.
#pragma once

#include <string>
#include <vector>

namespace hapsim {

// Names for --encoding, as hapsim tells them: "UTF-8", "UTF-16LE", "GB18030", "Shift-JIS", ...
const std::vector<std::string>& known_encodings();

struct DecodedText {
  std::string text;      // UTF-8 without a mark
  std::string encoding;  // one of the above
  bool guessed = false;  // neither told nor marked, nor UTF-8
};

// Text as UTF-8. `told` is a name of the above or "": then a mark decides, zeros in every second
// byte (UTF-16), valid UTF-8, and last of GB18030, Shift-JIS, Big5, EUC-JP and Windows-1252 the one
// under which most words of headers are known (tables/header_words.h). Error(kUsage) for an unknown
// name, Error(kBadInput) at `name` for bytes that the encoding told cannot hold.
DecodedText decode(const std::string& bytes, const std::string& told, const std::string& name);

}  // namespace hapsim
