#include "systemc/machine/flash_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace brick {

namespace {

constexpr mode_t kPermissions = 0666;  // less the user's mask

[[noreturn]] void fail(const std::string& file, const std::string& what) {
  throw std::runtime_error(fmt::format("flash file {}: {}", file, what));
}
[[noreturn]] void fail_to_write(const std::string& file) {
  fail(file,
       fmt::format("cannot be written: {}; expected a file in a folder that can be written to", std::strerror(errno)));
}

// The new content, until it gets the file's name; gone if it does not.
class NewFile {
 public:
  explicit NewFile(const std::string& file) : file_(file), name_(fmt::format("{}.new-{}", place(file), ::getpid())) {
    fd_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kPermissions);
    if (fd_ < 0) fail_to_write(file_);
    struct stat old {};
    if (::stat(file_.c_str(), &old) == 0) (void)::fchmod(fd_, old.st_mode & 07777u);
  }
  ~NewFile() {
    if (fd_ >= 0) ::close(fd_);
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  void write(const std::uint8_t* data, std::size_t bytes) {
    while (bytes > 0) {
      const ssize_t written = ::write(fd_, data, bytes);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) fail_to_write(file_);
      data += written;
      bytes -= static_cast<std::size_t>(written);
    }
  }

  void take_its_place() {
    const bool kept = ::fsync(fd_) == 0, closed = ::close(std::exchange(fd_, -1)) == 0;
    if (!kept || !closed || std::rename(name_.c_str(), place(file_).c_str()) != 0) fail_to_write(file_);
    name_.clear();
  }

 private:
  // A link stays one: what it names is replaced, also where that is not there yet.
  static std::string place(const std::filesystem::path& file) {
    std::error_code none;
    const auto real = std::filesystem::canonical(file, none);
    if (!none) return real;
    const auto named = std::filesystem::read_symlink(file, none);
    return none ? file : file.parent_path() / named;
  }

  std::string file_, name_;
  int fd_ = -1;
};

}  // namespace

void FlashFile::load(std::uint8_t* data, std::size_t bytes) const {
  if (file_.empty()) return;
  std::error_code error;
  const bool exists = std::filesystem::exists(file_, error);
  if (error) fail(file_, "cannot be read: " + error.message());
  if (!exists) return save(data, bytes);  // tells now, not at the end, that it cannot be written
  if (!std::filesystem::is_regular_file(file_)) fail(file_, "is not a file");
  const auto size = std::filesystem::file_size(file_, error);
  if (error) fail(file_, "cannot be read: " + error.message());
  if (size != bytes) fail(file_, fmt::format("has {} bytes; expected {}", size, bytes));
  std::ifstream in(file_, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(bytes)))
    fail(file_, std::string("cannot be read: ") + std::strerror(errno));
  if (!std::ofstream(file_, std::ios::binary | std::ios::app)) fail_to_write(file_);
  const NewFile probe(file_);
}

void FlashFile::save(const std::uint8_t* data, std::size_t bytes) const {
  if (file_.empty()) return;
  NewFile file(file_);
  file.write(data, bytes);
  file.take_its_place();
}

}  // namespace brick
