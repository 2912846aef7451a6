#include "tables/raw_table.h"

#include <set>

#include "base/error.h"
#include "tables/container.h"

namespace hapsim {

void RawTable::set_header(const std::vector<std::string>& names) {
  std::set<std::string> seen;
  header.clear();
  for (std::size_t c = 0; c < names.size(); ++c) {
    std::string unique = names[c].empty() ? "column " + std::to_string(c + 1) : names[c];
    while (!seen.insert(unique).second) unique += "'";
    header.push_back(unique);
  }
  unit.assign(names.size(), "");
  columns.resize(names.size());
}

const std::vector<const Container*>& all_containers() {
  static const std::vector<const Container*> all{&kMatlabFile, &kHdf5File, &kBagFile, &kLvmFile,
                                                 &kTextFile};
  return all;
}

RawTable read_raw_table(Input& input, const TableOptions& options) {
  const std::string bytes = input.read_all();
  if (!options.topics.empty() && !kBagFile.sniff(bytes))
    fail_input(input.name(), "--topic: this is no bag of ROS", "leave out --topic");
  for (const Container* container : all_containers())
    if (container->sniff(bytes)) return container->read(bytes, input.name(), options);
  return {};
}

}  // namespace hapsim
