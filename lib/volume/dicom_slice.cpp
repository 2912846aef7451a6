#include "volume/dicom_slice.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gdcmAttribute.h>
#include <gdcmImageReader.h>
#include <gdcmTrace.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/byte_stream.h"
#include "base/error.h"
#include "io/stream.h"

namespace hapsim {

void fail_slice(const std::string& file, const std::string& wrong) {
  fail_input(file, wrong, "export the series again, or remove the file");
}

namespace {

constexpr unsigned kSecondsAFile = 60;

template <class T>
void convert(const std::vector<char>& from, double slope, double intercept,
             std::vector<float>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) {
    T value;
    std::memcpy(&value, from.data() + i * sizeof(T), sizeof(T));
    to[i] = static_cast<float>(static_cast<double>(value) * slope + intercept);
  }
}

bool has_magic(const std::string& file) {
  char head[132] = {};
  Input input(file);
  input.stream().read(head, sizeof head);
  return input.stream().gcount() == sizeof head && std::memcmp(head + 128, "DICM", 4) == 0;
}

// One slice with its place, and the series it is of; nothing when the file is no image.
std::optional<DicomSlice> read_slice(const std::string& file) {
  gdcm::ImageReader reader;
  reader.SetFileName(file.c_str());
  if (!reader.Read()) return {};
  const gdcm::Image& image = reader.GetImage();
  const gdcm::DataSet& set = reader.GetFile().GetDataSet();
  gdcm::Attribute<0x0020, 0x000e> series;
  series.SetFromDataSet(set);
  DicomSlice slice;
  slice.file = file;
  const unsigned* size = image.GetDimensions();
  if (image.GetNumberOfDimensions() == 3 && size[2] > 1) {
    fail_slice(file, "it holds several frames");
  }
  slice.columns = static_cast<int>(size[0]);
  slice.rows = static_cast<int>(size[1]);
  const gdcm::PixelFormat& format = image.GetPixelFormat();
  const double pixels = static_cast<double>(size[0]) * size[1];
  const double bytes = static_cast<double>(std::filesystem::file_size(file));
  if (format.GetSamplesPerPixel() != 1) fail_slice(file, "its pixels have colours");
  // JPEG and run-length coding pack a flat slice hard, yet not a thousandfold.
  if (pixels < 4 || pixels * format.GetPixelSize() > 2000 * bytes) {
    fail_slice(file,
               fmt::format("it claims {} x {} pixels, which it cannot hold", size[0], size[1]));
  }
  if (!set.FindDataElement(gdcm::Tag(0x0020, 0x0032))) {
    fail_slice(file, "it does not say where the slice lies (ImagePositionPatient)");
  }
  std::vector<char> buffer(image.GetBufferLength());
  if (buffer.size() < static_cast<std::size_t>(pixels) * format.GetPixelSize() ||
      !image.GetBuffer(buffer.data())) {
    fail_slice(file, "its pixels are damaged or packed in an unknown way");
  }
  slice.values.resize(static_cast<std::size_t>(pixels));
  const double slope = image.GetSlope(), intercept = image.GetIntercept();
  switch (format.GetScalarType()) {
    case gdcm::PixelFormat::UINT8:
      convert<std::uint8_t>(buffer, slope, intercept, slice.values);
      break;
    case gdcm::PixelFormat::INT8:
      convert<std::int8_t>(buffer, slope, intercept, slice.values);
      break;
    case gdcm::PixelFormat::UINT12:
    case gdcm::PixelFormat::UINT16:
      convert<std::uint16_t>(buffer, slope, intercept, slice.values);
      break;
    case gdcm::PixelFormat::INT12:
    case gdcm::PixelFormat::INT16:
      convert<std::int16_t>(buffer, slope, intercept, slice.values);
      break;
    case gdcm::PixelFormat::UINT32:
      convert<std::uint32_t>(buffer, slope, intercept, slice.values);
      break;
    case gdcm::PixelFormat::INT32:
      convert<std::int32_t>(buffer, slope, intercept, slice.values);
      break;
    default:
      fail_slice(file, "its pixels are of an unknown kind");
  }
  const double* cosines = image.GetDirectionCosines();
  for (int k = 0; k < 3; ++k) {
    slice.origin[k] = image.GetOrigin(static_cast<unsigned>(k));
    slice.along_row[k] = cosines[k];
    slice.along_column[k] = cosines[k + 3];
  }
  slice.spacing = {image.GetSpacing(0), image.GetSpacing(1)};
  const char* uid = series.GetValue().c_str();
  slice.series = uid == nullptr ? "" : uid;
  return slice;
}

// What the child says of a file.
enum class Answer : char { kNothing, kSlice, kError };

bool put_slice(const ByteStream& stream, const DicomSlice& s) {
  const int size[2] = {s.columns, s.rows};
  return stream.put(size, sizeof size) && stream.put(s.spacing.data(), 2 * sizeof(double)) &&
         stream.put(s.origin.data(), 3 * sizeof(double)) &&
         stream.put(s.along_row.data(), 3 * sizeof(double)) &&
         stream.put(s.along_column.data(), 3 * sizeof(double)) && stream.put_all(s.series) &&
         stream.put_all(s.values);
}

bool get_slice(const ByteStream& stream, DicomSlice& s) {
  int size[2] = {};
  const bool good = stream.get(size, sizeof size) &&
                    stream.get(s.spacing.data(), 2 * sizeof(double)) &&
                    stream.get(s.origin.data(), 3 * sizeof(double)) &&
                    stream.get(s.along_row.data(), 3 * sizeof(double)) &&
                    stream.get(s.along_column.data(), 3 * sizeof(double)) &&
                    stream.get_all(s.series) && stream.get_all(s.values);
  s.columns = size[0];
  s.rows = size[1];
  return good;
}

// One file in the child; false when the parent is gone.
bool answer(const ByteStream& stream, const std::string& file) {
  std::optional<DicomSlice> slice;
  std::string wrong;
  try {
    if (has_magic(file)) slice = read_slice(file);
  } catch (const Error& error) {
    wrong = error.what();
  } catch (const std::exception&) {
    wrong = file + ": it is damaged; export the series again, or remove the file";
  }
  const Answer said = !wrong.empty() ? Answer::kError : (slice ? Answer::kSlice : Answer::kNothing);
  if (!stream.put(&said, sizeof said)) return false;
  if (said == Answer::kError) return stream.put_all(wrong);
  return said == Answer::kNothing || put_slice(stream, *slice);
}

// Damaged lengths ask for gigabytes: beyond what the largest file can need, allocation fails.
void limit_memory(const std::vector<std::string>& files) {
  std::uintmax_t largest = 0;
  for (const std::string& file : files) {
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);
    if (!unknown) largest = std::max(largest, size);
  }
  long pages = 0;
  if (std::FILE* own = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(own, "%ld", &pages) != 1) pages = 0;
    std::fclose(own);
  }
  if (pages == 0) return;
  const auto used = static_cast<std::uintmax_t>(pages) * static_cast<std::uintmax_t>(getpagesize());
  const auto most = static_cast<rlim_t>(used + (256u << 20) + 40 * largest);
  const rlimit memory = {most, most};
  setrlimit(RLIMIT_AS, &memory);
}

[[noreturn]] void child(int fd, const std::vector<std::string>& files) {
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGALRM}) std::signal(signal, SIG_DFL);
  const rlimit no_core = {0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  limit_memory(files);
  const int quiet = open("/dev/null", O_WRONLY);
  dup2(quiet, STDERR_FILENO);
  dup2(quiet, STDOUT_FILENO);
  gdcm::Trace::DebugOff();
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  const ByteStream stream(fd);
  for (const std::string& file : files) {
    alarm(kSecondsAFile);
    if (!answer(stream, file)) break;
  }
  _exit(0);
}

// Ends and collects the child, closes the stream.
struct Child {
  pid_t pid;
  int fd;
  ~Child() {
    close(fd);
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
  }
};

}  // namespace

std::vector<DicomSlice> read_dicom_slices(const std::vector<std::string>& files) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    fail_io("", "no socket can be made", "close other programs");
  const pid_t pid = fork();
  if (pid < 0) fail_io("", "no process can be started", "close other programs");
  if (pid == 0) {
    close(ends[0]);
    child(ends[1], files);
  }
  close(ends[1]);
  const Child worker{pid, ends[0]};
  const ByteStream stream(ends[0]);
  std::vector<DicomSlice> slices;
  for (const std::string& file : files) {
    Answer said = Answer::kNothing;
    if (!stream.get(&said, sizeof said)) fail_slice(file, "it is damaged");
    if (said == Answer::kNothing) continue;
    if (said == Answer::kError) {
      std::string text;
      stream.get_all(text);
      // "file: what is wrong; mend", as it was thrown in the child.
      const std::string what = text.substr(std::min(text.size(), file.size() + 2));
      fail_slice(file, what.substr(0, what.rfind(';')));
    }
    DicomSlice slice;
    slice.file = file;
    if (!get_slice(stream, slice)) fail_slice(file, "it is damaged");
    slices.push_back(std::move(slice));
  }
  return slices;
}

}  // namespace hapsim
