#include "app/named_files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "systemc/core/usage_error.h"

namespace brick {

namespace fs = std::filesystem;

namespace {

// One file by two names: links too, and a file that is not there yet.
bool is_same(const std::string& a, const std::string& b) {
  std::error_code none;
  if (fs::exists(a, none) && fs::exists(b, none)) return fs::is_regular_file(a, none) && fs::equivalent(a, b, none);
  const fs::path first = fs::weakly_canonical(fs::absolute(a), none);
  return !none && first == fs::weakly_canonical(fs::absolute(b), none) && !none;
}

}  // namespace

void NamedFiles::add(const std::string& option, const std::string& file, bool written) {
  if (!file.empty() && file != "-") files_.push_back({option, file, written});
}

void NamedFiles::check() const {
  for (std::size_t later = 0; later < files_.size(); ++later)
    for (std::size_t first = 0; first < later; ++first) {
      const Named &a = files_[first], &b = files_[later];
      if ((!a.written && !b.written) || !is_same(a.file, b.file)) continue;
      const Named& output = b.written ? b : a;
      const Named& other = b.written ? a : b;
      throw UsageError(fmt::format("{}: is {} too; expected another file", output.text(), other.text()));
    }
}

void need_writable(const std::string& option, const std::string& file) {
  std::error_code none;
  const bool there = fs::exists(file, none);
  if (there && !fs::is_regular_file(file, none)) return;  // to open a pipe would wait
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (opened < 0)
    throw UsageError(
        fmt::format("{} {}: cannot be written: {}; expected a writable place", option, file, std::strerror(errno)));
  close(opened);
  if (!there) fs::remove(file, none);
}

}  // namespace brick
