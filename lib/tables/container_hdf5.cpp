// HDF5 files, by libhdf5: datasets of numbers, their groups, and their attribute "units" or "unit".
#include <hdf5.h>

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "tables/container.h"
#include "tables/named_arrays.h"

namespace hapsim {
namespace {

constexpr hsize_t kMostValues = 1u << 28;

// A handle of the library, closed by `close`.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: it stands for the id everywhere
  bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

std::string text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return "";
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose);
  if (!attribute.good() || H5Tget_class(type) != H5T_STRING) return "";
  const Handle space(H5Aget_space(attribute), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1) return "";
  if (H5Tis_variable_str(type) > 0) {
    char* text = nullptr;
    if (H5Aread(attribute, type, &text) < 0 || text == nullptr) return "";
    const std::string out = text;
    H5free_memory(text);
    return out;
  }
  std::string out(H5Tget_size(type) + 1, '\0');
  if (H5Aread(attribute, type, out.data()) < 0) return "";
  return out.c_str();
}

struct Visit {
  hid_t file;
  std::vector<NamedArray>* arrays;
};

void add_numbers(hid_t set, hid_t type, const std::string& path, std::vector<NamedArray>& arrays) {
  const Handle space(H5Dget_space(set), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0 || rank > 2) return;
  hsize_t size[2] = {1, 1};
  H5Sget_simple_extent_dims(space, size, nullptr);
  if (size[0] == 0 || size[1] == 0 || size[0] > kMostValues / size[1]) return;
  NamedArray a;
  a.path = path;
  a.rows = size[0];
  a.columns = size[1];
  a.unit = text_attribute(set, "units");
  if (a.unit.empty()) a.unit = text_attribute(set, "unit");
  a.values.resize(a.rows * a.columns);
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, a.values.data()) >= 0)
    arrays.push_back(std::move(a));
}

// A table of records: each member of numbers is a column.
void add_members(hid_t set, hid_t type, const std::string& path, std::vector<NamedArray>& arrays) {
  for (int i = 0; i < H5Tget_nmembers(type); ++i) {
    const H5T_class_t kind = H5Tget_member_class(type, static_cast<unsigned>(i));
    if (kind != H5T_FLOAT && kind != H5T_INTEGER) continue;
    const std::unique_ptr<char, herr_t (*)(void*)> name(
        H5Tget_member_name(type, static_cast<unsigned>(i)), H5free_memory);
    const Handle one(H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose);
    H5Tinsert(one, name.get(), 0, H5T_NATIVE_DOUBLE);
    add_numbers(set, one, path + "/" + name.get(), arrays);
  }
}

herr_t visit(hid_t, const char* path, const H5O_info_t* info, void* data) {
  const auto& to = *static_cast<Visit*>(data);
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Handle set(H5Dopen2(to.file, path, H5P_DEFAULT), H5Dclose);
  if (!set.good()) return 0;
  const Handle type(H5Dget_type(set), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_FLOAT || kind == H5T_INTEGER)
    add_numbers(set, H5T_NATIVE_DOUBLE, path, *to.arrays);
  if (kind == H5T_COMPOUND) add_members(set, type, path, *to.arrays);
  return 0;
}

bool is_hdf5(const std::string& bytes) {
  return bytes.rfind("\x89HDF\r\n\x1a\n", 0) == 0;
}

RawTable read_hdf5(const std::string& bytes, const std::string& name, const TableOptions& options) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it prints what it finds wrong
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, 1u << 16, false);
  std::string image = bytes;
  H5Pset_file_image(access, image.data(), image.size());
  // The library refuses an image under the name of a file that is there.
  const Handle file(H5Fopen(("image of " + name).c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  if (!file.good()) fail_input(name, "the HDF5 file cannot be read", "is it whole?");
  std::vector<NamedArray> arrays;
  Visit to{file, &arrays};
  if (H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, &to, H5O_INFO_BASIC) < 0)
    fail_input(name, "the HDF5 file is damaged", "is it whole?");
  return table_of(std::move(arrays), name, options);
}

}  // namespace

const Container kHdf5File{"HDF5 file", is_hdf5, read_hdf5};

}  // namespace hapsim
