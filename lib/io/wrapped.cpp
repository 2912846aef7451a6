#include "io/wrapped.h"

#include "base/error.h"

namespace hapsim {

void refuse_wrapped(const std::string& name, std::string_view first) {
  const auto begins = [&](std::string_view with) { return first.starts_with(with); };
  // Every other byte of Latin letters and digits is 0.
  const bool wide = first.size() > 3 && (first[0] == '\0') != (first[1] == '\0') &&
                    (first[0] == '\0') == (first[2] == '\0') &&
                    (first[1] == '\0') == (first[3] == '\0');
  if (begins("\xff\xfe") || begins("\xfe\xff") || wide)
    fail_input(name, "this is UTF-16 text", "save it as UTF-8 (iconv -f UTF-16 -t UTF-8)");
  if (begins("\xef\xbb\xbf"))
    fail_input(name, "a byte order mark stands before the text", "save it as UTF-8 without one");
  if (begins("PK\x03\x04"))
    fail_input(name, "this looks like a spreadsheet or zip file",
               "unpack it; export the sheet as CSV");
  if (begins("\x1f\x8b"))
    fail_input(name, "this is compressed by gzip", "unpack it: gzip -dc FILE | ...");
  if (begins("<!DOCTYPE") || begins("<html"))
    fail_input(name, "this is a web page", "download the file itself");
}

}  // namespace hapsim
