#include "app/control/channel.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "systemc/core/usage_error.h"

namespace brick {

namespace {

constexpr const char* kFd = "fd:";
constexpr const char* kGone = "the client has gone";

int inherited(const std::string& place) {
  const std::string digits = place.substr(std::strlen(kFd));
  int kind = 0;
  socklen_t size = sizeof kind;
  if (!digits.empty() && digits.size() < 6 && digits.find_first_not_of("0123456789") == std::string::npos) {
    const int fd = std::stoi(digits);
    if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &kind, &size) == 0 && kind == SOCK_STREAM) return fd;
  }
  throw UsageError(fmt::format("{}: is no open stream socket; expected its number, or a path", place));
}

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path)
    throw UsageError(
        fmt::format("{}: is no path of a socket; expected 1 to {} characters", path, sizeof address.sun_path - 1));
  path.copy(address.sun_path, path.size());
  return address;
}

// A socket that nobody listens at is what a killed process has left.
bool is_left_over(const sockaddr_un& address) {
  struct stat status {};
  if (lstat(address.sun_path, &status) != 0 || !S_ISSOCK(status.st_mode)) return false;
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);  // it may have no room for one more
  const bool refused =
      connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 && errno == ECONNREFUSED;
  ::close(fd);
  return refused;
}

int listening_at(const std::string& path) {
  const sockaddr_un address = address_of(path);
  if (is_left_over(address)) unlink(path.c_str());
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const mode_t mask = umask(0177);
  const bool bound = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  const int error = errno;
  umask(mask);
  if (bound && listen(fd, 1) == 0) return fd;
  ::close(fd);
  throw UsageError(fmt::format("{}: {}; expected a place for a new socket", path, std::strerror(error)));
}

}  // namespace

ControlChannel::ControlChannel(const std::string& place) {
  if (place.rfind(kFd, 0) == 0) {
    client_ = inherited(place);
    return;
  }
  listener_ = listening_at(place);
  path_ = place;
}

ControlChannel::~ControlChannel() {
  if (client_ >= 0) ::close(client_);
  stop_listening();
}

void ControlChannel::stop_listening() {
  if (listener_ < 0) return;
  unlink(path_.c_str());
  ::close(listener_);
  listener_ = -1;
}

bool ControlChannel::closed() const {
  pollfd one{client_, 0, 0};  // POLLHUP: of both directions
  return client_ >= 0 && poll(&one, 1, 0) > 0;
}

// Once; false: call again.
bool ControlChannel::ready(int fd, short events, const Idle& idle) const {
  pollfd one{fd, events, 0};
  return poll(&one, 1, static_cast<int>(idle().count())) > 0;
}

// One that leaves without a byte was none: another `brick control` looks so whether anybody listens at the path.
void ControlChannel::accept(const Idle& idle) {
  while (listener_ >= 0) {
    if (!ready(client_ < 0 ? listener_ : client_, POLLIN, idle)) continue;
    if (client_ < 0) {
      client_ = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      continue;
    }
    char first;
    if (recv(client_, &first, 1, MSG_PEEK | MSG_DONTWAIT) == 1) return stop_listening();
    ::close(client_);
    client_ = -1;
  }
}

std::string ControlChannel::read(const Idle& idle) {
  for (;;) {
    if (auto line = lines_.next()) return *line;
    if (!ready(client_, POLLIN, idle)) continue;
    std::array<char, 65536> piece;
    const ssize_t count = recv(client_, piece.data(), piece.size(), MSG_DONTWAIT);
    if (count > 0)
      lines_.add({piece.data(), static_cast<std::size_t>(count)});
    else if (count == 0 || (errno != EAGAIN && errno != EINTR))
      throw ChannelClosed(kGone);
  }
}

void ControlChannel::write(const std::string& line, const Idle& idle) {
  for (std::size_t sent = 0; sent < line.size();) {
    const ssize_t count = send(client_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count > 0)
      sent += static_cast<std::size_t>(count);
    else if (errno != EAGAIN && errno != EINTR)
      throw ChannelClosed(kGone);
    else
      ready(client_, POLLOUT, idle);
  }
}

}  // namespace brick
