// MATLAB and HDF5 files that other libraries' writers make.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <matio.h>

#include <filesystem>

#include "unit/import/synthetic.h"

namespace hapsim::test {
namespace {

class Containers : public testing::Test {
 protected:
  void SetUp() override {
    for (const RampRow& r : ramp({})) {
      t.push_back(r.t);
      travel.push_back(r.travel);
      force.push_back(r.force);
    }
    path =
        (std::filesystem::temp_directory_path() / ("containers_test_" + std::to_string(getpid())))
            .string();
  }
  void TearDown() override { std::filesystem::remove(path); }

  ImportResult import_path(const TableOptions& options = {}) const {
    Input input(path);
    return import_recording(read_raw_table(input, options), {});
  }
  void expect_ramp(const Recording& out, std::size_t presses) const {
    EXPECT_EQ(out.presses().size(), presses);
    double deepest = 0;
    for (const Vec3& u : out.u) deepest = std::max(deepest, -u.z());
    EXPECT_NEAR(deepest, 6e-3, 0.15e-3);
    EXPECT_NEAR(out.t.back(), t.back(), 1e-9);
  }
  matvar_t* column(const char* name, std::vector<double>& values) const {
    std::size_t dims[] = {values.size(), 1};
    return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, values.data(), 0);
  }
  void write(mat_ft version, matvar_t* v, matvar_t* more = nullptr,
             matvar_t* last = nullptr) const {
    mat_t* mat = Mat_CreateVer(path.c_str(), nullptr, version);
    for (matvar_t* each : {v, more, last})
      if (each) {
        Mat_VarWrite(mat, each, MAT_COMPRESSION_ZLIB);
        Mat_VarFree(each);
      }
    Mat_Close(mat);
  }

  std::vector<double> t, travel, force;
  std::string path;
};

TEST_F(Containers, MatlabVariablesAreColumns) {
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    write(version, column("time_s", t), column("travel_mm", travel), column("force_N", force));
    expect_ramp(import_path().recording, 1);
  }
}

TEST_F(Containers, MatlabArraysOfStructsAreRecordings) {
  for (const mat_ft version : {MAT_FT_MAT5, MAT_FT_MAT73}) {
    const char* fields[] = {"time_s", "travel_mm", "force_N", "radius"};
    std::size_t dims[] = {1, 2}, one[] = {1, 1};
    double radius = 3;
    matvar_t* trials = Mat_VarCreateStruct("trials", 2, dims, fields, 4);
    for (std::size_t i = 0; i < 2; ++i) {
      Mat_VarSetStructFieldByName(trials, "time_s", i, column("time_s", t));
      Mat_VarSetStructFieldByName(trials, "travel_mm", i, column("travel_mm", travel));
      Mat_VarSetStructFieldByName(trials, "force_N", i, column("force_N", force));
      Mat_VarSetStructFieldByName(
          trials, "radius", i,
          Mat_VarCreate("radius", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, one, &radius, 0));
    }
    write(version, trials);
    const ImportResult result = import_path();
    expect_ramp(result.recording, 2);
    EXPECT_EQ(result.recording.extra_header, std::vector<std::string>{"radius"});
  }
}

TEST_F(Containers, SeveralTablesAreChosenByPart) {
  std::vector<double> other(40, 1.0);
  const char* fields[] = {"time_s", "travel_mm", "force_N"};
  const char* noise[] = {"power"};
  std::size_t one[] = {1, 1};
  matvar_t* press = Mat_VarCreateStruct("press", 2, one, fields, 3);
  Mat_VarSetStructFieldByName(press, "time_s", 0, column("time_s", t));
  Mat_VarSetStructFieldByName(press, "travel_mm", 0, column("travel_mm", travel));
  Mat_VarSetStructFieldByName(press, "force_N", 0, column("force_N", force));
  matvar_t* spectrum = Mat_VarCreateStruct("spectrum", 2, one, noise, 1);
  Mat_VarSetStructFieldByName(spectrum, "power", 0, column("power", other));
  write(MAT_FT_MAT5, press, spectrum);
  try {
    import_path();
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("press, spectrum; say which by --part"),
              std::string::npos)
        << error.what();
  }
  TableOptions options;
  options.part = "press";
  expect_ramp(import_path(options).recording, 1);
}

TEST_F(Containers, Hdf5DatasetsAreColumnsWithTheirUnits) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t size = t.size();
  const auto add = [&](const char* name, std::vector<double>& values, const char* unit) {
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t set =
        H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    const hid_t type = H5Tcopy(H5T_C_S1), scalar = H5Screate(H5S_SCALAR);
    H5Tset_size(type, std::string(unit).size());
    const hid_t attribute = H5Acreate2(set, "units", type, scalar, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, type, unit);
    H5Aclose(attribute);
    H5Sclose(scalar);
    H5Tclose(type);
    H5Dclose(set);
    H5Sclose(space);
  };
  for (double& v : force) v *= 1000;
  add("time", t, "s");
  add("displacement", travel, "mm");
  add("force", force, "mN");
  H5Fclose(file);
  const ImportResult result = import_path();
  expect_ramp(result.recording, 1);
  double most = 0;
  for (const Vec3& f : result.recording.f) most = std::max(most, f.z());
  EXPECT_NEAR(most, *std::max_element(force.begin(), force.end()) / 1000, 1e-6);
}

TEST_F(Containers, DamagedFilesAreRefused) {
  write(MAT_FT_MAT5, column("time_s", t), column("travel_mm", travel), column("force_N", force));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 4);
  EXPECT_THROW(import_path(), Error);
}

}  // namespace
}  // namespace hapsim::test
