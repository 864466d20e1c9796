#include "systemc/core/input_file.h"

#include <array>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "systemc/core/usage_error.h"

namespace brick {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& shown, const std::string& why,
                       const std::string& expected) {
  throw UsageError(fmt::format("{}: {}; expected {}", shown.empty() ? path : shown, why, expected));
}

// What the process has been given open: nobody has to be waited for.
bool is_descriptor(const std::string& path) {
  return path == "/dev/stdin" || path.rfind("/dev/fd/", 0) == 0 || path.rfind("/proc/", 0) == 0;
}

}  // namespace

bool is_named_pipe(const std::string& path) {
  std::error_code ignored;
  return fs::is_fifo(path, ignored) && !is_descriptor(path);
}

void need_regular_file(const std::string& path, const std::string& expected, const std::string& shown) {
  std::error_code ignored;
  if (!fs::exists(path, ignored) || fs::is_directory(path, ignored)) fail(path, shown, "cannot be read", expected);
  if (!fs::is_regular_file(path, ignored)) fail(path, shown, "is no regular file", expected);
  if (!std::ifstream(path)) fail(path, shown, "cannot be read", expected);
}

std::string read_input_file(const std::string& path, const std::string& expected, const std::string& shown) {
  if (is_named_pipe(path)) fail(path, shown, "is no regular file", expected);
  std::error_code ignored;
  std::ifstream file(path, std::ios::binary);
  if (!file || fs::is_directory(path, ignored)) fail(path, shown, "cannot be read", expected);
  std::string text;
  for (std::array<char, 1 << 16> piece; file.read(piece.data(), piece.size()) || file.gcount() > 0;) {
    text.append(piece.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > kMostInputMebibytes << 20)
      fail(path, shown, fmt::format("has more than {} MiB", kMostInputMebibytes), expected);
  }
  if (file.bad()) fail(path, shown, "cannot be read to its end", expected);
  return text;
}

}  // namespace brick
