#include "app/status_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

namespace brick {

namespace {
constexpr unsigned kLeastRows = 3;

winsize terminal_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) size = {};
  return size;
}

void write(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}
}  // namespace

StatusLine::StatusLine() {
  const char* terminal = std::getenv("TERM");
  shown_ = isatty(STDOUT_FILENO) == 1 && terminal != nullptr && std::string_view(terminal) != "dumb" &&
           terminal_size().ws_row >= kLeastRows;
  if (shown_) reserve();
}

// ESC 7, 8: cursor kept, put back; CSI r: rows that scroll.
void StatusLine::reserve() {
  const winsize size = terminal_size();
  rows_ = size.ws_row;
  columns_ = size.ws_col;
  write(rows_ >= kLeastRows ? fmt::format("\n\033[A\0337\033[1;{}r\0338", rows_ - 1) : "\0337\033[r\0338");
}

StatusLine::~StatusLine() {
  if (shown_ && rows_ >= kLeastRows) write(fmt::format("\0337\033[r\033[{};1H\033[K\0338", rows_));
}

void StatusLine::show(const std::string& text) {
  if (!shown_) return;
  const winsize size = terminal_size();
  if (size.ws_row != rows_ || size.ws_col != columns_) reserve();
  if (rows_ < kLeastRows) return;
  write(fmt::format("\0337\033[{};1H\033[7m{:<{}}\033[0m\0338", rows_, text.substr(0, columns_), columns_));
}

}  // namespace brick
