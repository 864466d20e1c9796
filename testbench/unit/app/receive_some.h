// What a socket has received, for tests. Nothing for ten seconds is a failure, not an end of the run.
#pragma once

#include <sys/socket.h>
#include <sys/time.h>

#include <cstddef>

namespace brick {

// At most so many bytes: their number, 0 at the end, below 0 for an error or nothing.
template <class Socket>
ssize_t receive_some(Socket& socket, char* at, std::size_t most) {
  const timeval longest{10, 0};
  ::setsockopt(socket.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &longest, sizeof longest);
  return ::recv(socket.native_handle(), at, most, 0);
}

}  // namespace brick
