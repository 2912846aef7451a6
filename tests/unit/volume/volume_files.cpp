#include "unit/volume/volume_files.h"

#include <fmt/format.h>
#include <gdcmAttribute.h>
#include <gdcmImageWriter.h>
#include <gdcmTrace.h>
#include <nifti2_io.h>
#include <teem/nrrd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace hapsim::test {
namespace {

std::vector<short> shorts(const Volume& volume) {
  std::vector<short> result;
  for (const float v : volume.values) result.push_back(static_cast<short>(std::lround(v)));
  return result;
}

}  // namespace

void write_nrrd(const Volume& volume, const std::string& path, const std::string& encoding) {
  std::vector<short> data = shorts(volume);
  Nrrd* nrrd = nrrdNew();
  size_t size[3] = {static_cast<size_t>(volume.size[0]), static_cast<size_t>(volume.size[1]),
                    static_cast<size_t>(volume.size[2])};
  nrrdWrap_nva(nrrd, data.data(), nrrdTypeShort, 3, size);
  nrrdSpaceSet(nrrd, nrrdSpaceLeftPosteriorSuperior);
  for (int r = 0; r < 3; ++r) {
    nrrd->spaceUnits[r] = strdup("mm");
    nrrd->spaceOrigin[r] = 1e3 * volume.to_world.matrix()(r, 3);
    for (int c = 0; c < 3; ++c)
      nrrd->axis[c].spaceDirection[r] = 1e3 * volume.to_world.matrix()(r, c);
  }
  NrrdIoState* state = nrrdIoStateNew();
  state->encoding = nrrdEncodingArray[airEnumVal(nrrdEncodingType, encoding.c_str())];
  const int failed = nrrdSave(path.c_str(), nrrd, state);
  nrrdIoStateNix(state);
  nrrdNix(nrrd);
  if (failed != 0) throw std::runtime_error("NRRD not written");
}

void write_nifti(const Volume& volume, const std::string& path) {
  const std::vector<short> data = shorts(volume);
  const int64_t dim[8] = {3, volume.size[0], volume.size[1], volume.size[2], 1, 1, 1, 1};
  nifti_image* image = nifti_make_new_nim(dim, DT_INT16, 1);
  std::memcpy(image->data, data.data(), 2 * data.size());
  nifti_set_filenames(image, path.c_str(), 0, 1);
  image->nifti_type = NIFTI_FTYPE_NIFTI1_1;
  image->xyz_units = NIFTI_UNITS_MM;
  image->sform_code = NIFTI_XFORM_SCANNER_ANAT;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) {
      image->sto_xyz.m[r][c] = (r < 3 ? 1e3 : 1) * volume.to_world.matrix()(r, c);
    }
  }
  for (int k = 1; k <= 3; ++k) image->pixdim[k] = 1e3 * volume.to_world.linear().col(k - 1).norm();
  nifti_image_write(image);
  nifti_image_free(image);
}

void write_dicom(const Volume& volume, const std::string& folder, const std::string& series,
                 double slope, double intercept) {
  gdcm::Trace::WarningOff();
  std::filesystem::create_directories(folder);
  const std::vector<short> data = shorts(volume);
  const std::size_t pixels = static_cast<std::size_t>(volume.size[0]) * volume.size[1];
  const Eigen::Matrix3d a = volume.to_world.linear();
  for (int k = 0; k < volume.size[2]; ++k) {
    gdcm::ImageWriter writer;
    gdcm::Image& image = writer.GetImage();
    image.SetNumberOfDimensions(2);
    const unsigned size[2] = {static_cast<unsigned>(volume.size[0]),
                              static_cast<unsigned>(volume.size[1])};
    image.SetDimensions(size);
    image.SetPixelFormat(gdcm::PixelFormat::INT16);
    image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
    image.SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
    image.SetSlope(slope);
    image.SetIntercept(intercept);
    const Vec3 origin = 1e3 * (volume.to_world * Vec3(0, 0, k));
    double cosines[6];
    for (int r = 0; r < 3; ++r) {
      image.SetOrigin(static_cast<unsigned>(r), origin[r]);
      cosines[r] = a.col(0).normalized()[r];
      cosines[3 + r] = a.col(1).normalized()[r];
    }
    image.SetDirectionCosines(cosines);
    image.SetSpacing(0, 1e3 * a.col(0).norm());
    image.SetSpacing(1, 1e3 * a.col(1).norm());
    std::vector<short> stored(data.begin() + static_cast<long>(k * pixels),
                              data.begin() + static_cast<long>((k + 1) * pixels));
    for (short& v : stored) v = static_cast<short>(std::lround((v - intercept) / slope));
    gdcm::DataElement element(gdcm::Tag(0x7fe0, 0x0010));
    element.SetByteValue(reinterpret_cast<const char*>(stored.data()),
                         gdcm::VL(static_cast<uint32_t>(2 * pixels)));
    image.SetDataElement(element);
    gdcm::DataSet& set = writer.GetFile().GetDataSet();
    gdcm::Attribute<0x0008, 0x0016> kind = {"1.2.840.10008.5.1.4.1.1.2"};
    gdcm::Attribute<0x0020, 0x000e> uid = {series.c_str()};
    set.Replace(kind.GetAsDataElement());
    set.Replace(uid.GetAsDataElement());
    // Names that do not sort as the slices lie.
    writer.SetFileName(fmt::format("{}/{:03}.dcm", folder, (k * 37) % 101).c_str());
    if (!writer.Write()) throw std::runtime_error("DICOM not written");
  }
}

Volume ball_volume(double radius, const Vec3& centre) {
  Volume volume;
  volume.size = {52, 46, 31};
  const Vec3 spacing(0.8e-3, 0.9e-3, 1.4e-3);
  volume.to_world.linear() =
      Eigen::AngleAxisd(0.4, Vec3(1, 2, -0.5).normalized()).toRotationMatrix() *
      spacing.asDiagonal();
  const Vec3 middle(25.3, 22.1, 14.6);
  volume.to_world.translation() = centre - volume.to_world.linear() * middle;
  const double s = kBlur;
  for (int k = 0; k < volume.size[2]; ++k) {
    for (int j = 0; j < volume.size[1]; ++j) {
      for (int i = 0; i < volume.size[0]; ++i) {
        const double r = std::max((volume.to_world * Vec3(i, j, k) - centre).norm(), 1e-9);
        const double out = r + radius, in = r - radius, root = std::sqrt(2.) * s;
        const double full =
            (std::erf(out / root) - std::erf(in / root)) / 2 -
            s / (r * std::sqrt(2 * M_PI)) *
                (std::exp(-in * in / (2 * s * s)) - std::exp(-out * out / (2 * s * s)));
        volume.values.push_back(static_cast<float>(1000 * full));
      }
    }
  }
  return volume;
}

}  // namespace hapsim::test
