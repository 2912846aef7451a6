// MATLAB files of version 5 and 7.3, by libmatio.
#include <matio.h>

#include <memory>

#include "base/error.h"
#include "io/number.h"
#include "tables/container.h"
#include "tables/named_arrays.h"
#include "tables/scratch_file.h"

namespace hapsim {
namespace {

bool is_matlab(const std::string& bytes) {
  return bytes.rfind("MATLAB 5.0 MAT-file", 0) == 0 || bytes.rfind("MATLAB 7.3 MAT-file", 0) == 0;
}

// Elements of a numeric variable as doubles; false for other classes.
template <class T>
void copy(const matvar_t& v, NamedArray& a) {
  const T* data = static_cast<const T*>(v.data);
  for (std::size_t r = 0; r < a.rows; ++r)
    for (std::size_t c = 0; c < a.columns; ++c)
      a.values[r * a.columns + c] = static_cast<double>(data[c * a.rows + r]);
}

bool numbers(const matvar_t& v, NamedArray& a) {
  if (v.rank != 2 || v.isComplex || v.data == nullptr) return false;
  a.rows = v.dims[0];
  a.columns = v.dims[1];
  if (v.nbytes < a.rows * a.columns * static_cast<std::size_t>(v.data_size)) return false;
  a.values.resize(a.rows * a.columns);
  switch (v.data_type) {
    case MAT_T_DOUBLE:
      copy<double>(v, a);
      return true;
    case MAT_T_SINGLE:
      copy<float>(v, a);
      return true;
    case MAT_T_INT8:
      copy<std::int8_t>(v, a);
      return true;
    case MAT_T_UINT8:
      copy<std::uint8_t>(v, a);
      return true;
    case MAT_T_INT16:
      copy<std::int16_t>(v, a);
      return true;
    case MAT_T_UINT16:
      copy<std::uint16_t>(v, a);
      return true;
    case MAT_T_INT32:
      copy<std::int32_t>(v, a);
      return true;
    case MAT_T_UINT32:
      copy<std::uint32_t>(v, a);
      return true;
    case MAT_T_INT64:
      copy<std::int64_t>(v, a);
      return true;
    case MAT_T_UINT64:
      copy<std::uint64_t>(v, a);
      return true;
    default:
      return false;
  }
}

struct Content {
  std::vector<NamedArray> arrays;
  bool objects = false;
};

void collect(matvar_t& v, const std::string& path, int depth, Content& content) {
  constexpr int kDeepest = 8;
  if (depth > kDeepest) return;
  const auto elements = [](const matvar_t& m) {
    std::size_t n = 1;
    for (int i = 0; i < m.rank; ++i) n *= m.dims[i];
    return n;
  };
  switch (v.class_type) {
    case MAT_C_STRUCT: {
      const unsigned fields = Mat_VarGetNumberOfFields(&v);
      char* const* names = Mat_VarGetStructFieldnames(&v);
      const std::size_t n = elements(v);
      for (std::size_t i = 0; i < n; ++i)
        for (unsigned f = 0; f < fields; ++f) {
          matvar_t* field = Mat_VarGetStructFieldByIndex(&v, f, i);
          if (field)
            collect(*field,
                    path + (n > 1 ? "[" + std::to_string(i + 1) + "]" : "") + "/" + names[f],
                    depth + 1, content);
        }
      return;
    }
    case MAT_C_CELL: {
      const std::size_t n = elements(v);
      for (std::size_t i = 0; i < n; ++i) {
        matvar_t* cell = Mat_VarGetCell(&v, static_cast<int>(i));
        if (cell && cell->class_type == MAT_C_STRUCT)
          collect(*cell, path + "[" + std::to_string(i + 1) + "]", depth + 1, content);
      }
      return;
    }
    case MAT_C_OBJECT:
    case MAT_C_OPAQUE:
    case MAT_C_FUNCTION:
      content.objects = true;
      return;
    case MAT_C_CHAR:
    case MAT_C_SPARSE:
      return;
    default: {
      NamedArray a;
      a.path = path;
      if (numbers(v, a) && !a.values.empty()) content.arrays.push_back(std::move(a));
    }
  }
}

RawTable read_matlab(const std::string& bytes, const std::string& name,
                     const TableOptions& options) {
  const ScratchFile file(bytes, name);
  const std::unique_ptr<mat_t, int (*)(mat_t*)> mat(Mat_Open(file.path().c_str(), MAT_ACC_RDONLY),
                                                    Mat_Close);
  if (!mat) fail_input(name, "the MATLAB file cannot be read", "save it again: save FILE -v7");
  Content content;
  while (matvar_t* next = Mat_VarReadNext(mat.get())) {
    const std::unique_ptr<matvar_t, void (*)(matvar_t*)> v(next, Mat_VarFree);
    // Without a name: what MATLAB keeps of its classes' objects.
    if (v->name == nullptr || v->name[0] == '\0' || std::string_view(v->name).rfind("__", 0) == 0)
      content.objects = true;
    else
      collect(*v, v->name, 0, content);
  }
  if (content.arrays.empty() && content.objects)
    fail_input(name, "the MATLAB file holds objects of a class, which only MATLAB reads",
               "turn them into structs (struct(object)) and save again, or write a CSV: "
               "share/examples/import/write_probing.m");
  return table_of(std::move(content.arrays), name, options);
}

}  // namespace

const Container kMatlabFile{"MATLAB file (version 5 or 7.3)", is_matlab, read_matlab};

}  // namespace hapsim
