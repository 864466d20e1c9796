// The socket of the control channel: one client's end of a stream, and whether that client is still there.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/control/json_rpc.h"

namespace brick {

// The client has gone: nobody wants the rest of the session.
class ChannelClosed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ControlChannel {
 public:
  // `fd:N`: a socket that whoever started this process has left open. Else the path of a socket that is made here, for
  // this user alone, and removed when a client has spoken. Throws UsageError.
  explicit ControlChannel(const std::string& place);
  ~ControlChannel();
  ControlChannel(const ControlChannel&) = delete;
  ControlChannel& operator=(const ControlChannel&) = delete;

  // Waits for a client that says something, then for a whole line. `idle` is called in between, and says for how long
  // it may be left alone.
  using Idle = std::function<std::chrono::milliseconds()>;
  void accept(const Idle& idle);
  std::string read(const Idle& idle);
  void write(const std::string& line, const Idle& idle);
  bool closed() const;  // the client has gone, whatever of it is not read yet

 private:
  void stop_listening();
  void admit_all();
  void take(std::size_t n);                     // of the silent ones; the others are refused instead of left waiting
  void refuse(std::size_t n, const char* why);  // nullptr: it has gone
  bool ready(int fd, short events, const Idle& idle) const;

  int listener_ = -1, client_ = -1;
  std::vector<int> silent_;  // have connected and said nothing, the oldest first
  std::string path_;         // of the listener
  RpcLines lines_;
};

}  // namespace brick
