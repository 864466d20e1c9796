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
constexpr std::size_t kMostSilent = 16;  // the one that has said nothing for longest gives its place

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
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const mode_t mask = umask(0177);
  const bool bound = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  const int error = errno;
  umask(mask);
  if (bound && listen(fd, SOMAXCONN) == 0) return fd;
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
  for (const int client : silent_) ::close(client);
  stop_listening();
}

void ControlChannel::stop_listening() {
  if (listener_ < 0) return;
  unlink(path_.c_str());
  ::close(listener_);
  listener_ = -1;
}

// With one line, for which there is room, because nothing has been sent yet.
void ControlChannel::refuse(std::size_t n, const char* why) {
  if (why != nullptr) {
    const std::string line = error_line(nullptr, RpcError(rpc::kNoRequest, why));
    (void)!send(silent_[n], line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }
  ::close(silent_[n]);
  silent_.erase(silent_.begin() + static_cast<std::ptrdiff_t>(n));
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

void ControlChannel::admit_all() {
  for (int client; (client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC)) >= 0;) {
    if (silent_.size() == kMostSilent) refuse(0, "too many clients that say nothing; expected a request");
    silent_.push_back(client);
  }
}

void ControlChannel::take(std::size_t n) {
  client_ = silent_[n];
  silent_.erase(silent_.begin() + static_cast<std::ptrdiff_t>(n));
  admit_all();
  while (!silent_.empty()) refuse(0, "another client has the controller; expected a `brick control` for each");
  stop_listening();
}

// Whoever speaks first has the controller. One that leaves without a byte was none: another `brick control` looks so
// whether anybody listens at the path.
void ControlChannel::accept(const Idle& idle) {
  while (listener_ >= 0) {
    std::vector<pollfd> all{{listener_, POLLIN, 0}};
    for (const int client : silent_) all.push_back({client, POLLIN, 0});
    if (poll(all.data(), all.size(), static_cast<int>(idle().count())) <= 0) continue;
    for (std::size_t n = 0, at = 1; at < all.size(); ++at) {
      char first;
      if (all[at].revents == 0)
        ++n;
      else if (recv(silent_[n], &first, 1, MSG_PEEK | MSG_DONTWAIT) == 1)
        return take(n);
      else
        refuse(n, nullptr);
    }
    if (all[0].revents != 0) admit_all();
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
