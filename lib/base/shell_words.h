// Words of a POSIX shell: quoting them and taking a line apart, without any expansion.
#pragma once

#include <string>
#include <vector>

namespace hapsim {

// The word as a shell reads it back; plain words stay plain.
std::string shell_quoted(const std::string& word);

// The words joined by spaces, each quoted.
std::string shell_line(const std::vector<std::string>& words);

// Words separated by blanks; '...', "..." and \x as in a shell, $, * and the like are themselves.
// Error(kBadInput) beginning with `where`: a quote that never closes.
std::vector<std::string> split_words(const std::string& line, const std::string& where);

}  // namespace hapsim
