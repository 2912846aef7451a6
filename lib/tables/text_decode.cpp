#include "tables/text_decode.h"

#include "base/error.h"

namespace hapsim {
namespace {

void unify_line_ends(std::string& text) {
  std::size_t to = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r') {
      if (i + 1 < text.size() && text[i + 1] == '\n') continue;
      text[to++] = '\n';
    } else {
      text[to++] = text[i];
    }
  }
  text.resize(to);
}

}  // namespace

DecodedText decode_text(const std::string& bytes, const std::string& encoding,
                        const std::string& name) {
  const auto starts = [&bytes](std::string_view mark) {
    return bytes.compare(0, mark.size(), mark) == 0;
  };
  if (starts("PK\x03\x04") || starts("\xD0\xCF\x11\xE0"))
    fail_input(name, "this looks like a spreadsheet or zip file", "export the sheet as CSV");
  if (starts("MATLAB"))
    fail_input(name, "this is a MATLAB file of a version that is not known",
               "save it by save FILE -v7");
  if (starts("#ROSBAG"))
    fail_input(name, "this is a bag of ROS",
               "write its topics as CSV: rostopic echo -b BAG -p TOPIC");
  if (starts("TDSm"))
    fail_input(name, "this is a TDMS file of LabVIEW, which no library of Debian reads",
               "write it as .lvm or CSV");
  if (starts("\x89MCAP"))
    fail_input(name, "this is an MCAP file of ROS 2", "write its topics as CSV");
  if (starts("\x1f\x8b"))
    fail_input(name, "this is compressed by gzip", "unpack it: gzip -dc FILE | hs-import");
  DecodedText decoded = decode(bytes, encoding, name);
  if (decoded.text.find('\0') != decoded.text.npos)
    fail_input(name, "this looks like a binary file", "a table as text is needed");
  unify_line_ends(decoded.text);
  return decoded;
}

}  // namespace hapsim
