#include "systemc/machine/flash_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace brick {

namespace {

constexpr mode_t kPermissions = 0666;  // less the user's mask

[[noreturn]] void fail(const std::string& file, const std::string& what) {
  throw std::runtime_error(fmt::format("flash file {}: {}", file, what));
}
[[noreturn]] void fail_to_read(const std::string& file, const std::string& why) {
  fail(file, fmt::format("{}; expected one that brick has written, or none", why));
}
[[noreturn]] void fail_to_write(const std::string& file) {
  fail(file,
       fmt::format("cannot be written: {}; expected a file in a folder that can be written to", std::strerror(errno)));
}

// Where the file is written. A link stays one: what it names is replaced, also where that is not there yet.
std::string place(const std::filesystem::path& file) {
  std::error_code none;
  const auto real = std::filesystem::canonical(file, none);
  if (!none) return real;
  const auto named = std::filesystem::read_symlink(file, none);
  return none ? file : file.parent_path() / named;
}

constexpr const char* kNew = ".new-";  // and the process that writes it

// Of a process that is no more: nobody finishes it.
bool is_left_behind(const std::string& name, const std::string& file) {
  if (name.compare(0, file.size(), file) != 0) return false;
  const std::string process = name.substr(file.size());
  constexpr std::size_t kLongest = 10;  // digits of a process
  if (process.empty() || process.size() > kLongest || process[0] == '0' ||
      process.find_first_not_of("0123456789") != std::string::npos)
    return false;
  const long long number = std::stoll(process);
  return number <= std::numeric_limits<pid_t>::max() && ::kill(static_cast<pid_t>(number), 0) != 0 && errno == ESRCH;
}

void remove_what_is_left(const std::string& file) {
  const std::filesystem::path beside = place(file);
  const std::string begin = beside.filename().string() + kNew;
  std::error_code none;  // whoever may not look or remove here is told by what follows
  std::vector<std::filesystem::path> left;
  const auto folder = beside.has_parent_path() ? beside.parent_path() : std::filesystem::path(".");
  for (std::filesystem::directory_iterator at(folder, none), end; !none && at != end; at.increment(none))
    if (is_left_behind(at->path().filename().string(), begin)) left.push_back(at->path());
  for (const auto& path : left) std::filesystem::remove(path, none);
}

// The new content, until it gets the file's name; gone if it does not.
class NewFile {
 public:
  explicit NewFile(const std::string& file) : file_(file), name_(fmt::format("{}{}{}", place(file), kNew, ::getpid())) {
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
  std::string file_, name_;
  int fd_ = -1;
};

}  // namespace

void FlashFile::load(std::uint8_t* data, std::size_t bytes) {
  if (file_.empty()) return;
  remove_what_is_left(file_);
  std::error_code error;
  const bool exists = std::filesystem::exists(file_, error);
  if (error) fail_to_read(file_, "cannot be read: " + error.message());
  if (!exists) return write(data, bytes);  // tells now, not at the end, that it cannot be written
  if (!std::filesystem::is_regular_file(file_)) fail_to_read(file_, "is not a file");
  const auto size = std::filesystem::file_size(file_, error);
  if (error) fail_to_read(file_, "cannot be read: " + error.message());
  if (size != bytes) fail(file_, fmt::format("has {} bytes; expected {}", size, bytes));
  std::ifstream in(file_, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(bytes)))
    fail_to_read(file_, std::string("cannot be read: ") + std::strerror(errno));
  if (!std::ofstream(file_, std::ios::binary | std::ios::app)) fail_to_write(file_);
  const NewFile probe(file_);
  known_.assign(data, data + bytes);
}

void FlashFile::save(const std::uint8_t* data, std::size_t bytes) {
  std::error_code ignored;
  const bool same = known_.size() == bytes && std::equal(known_.begin(), known_.end(), data);
  if (!file_.empty() && !(same && std::filesystem::exists(file_, ignored))) write(data, bytes);
}

void FlashFile::write(const std::uint8_t* data, std::size_t bytes) {
  NewFile file(file_);
  file.write(data, bytes);
  file.take_its_place();
  known_.assign(data, data + bytes);
}

}  // namespace brick
