// The page's sockets, on a thread of their own (Boost.Beast). The simulation leaves the newest state in a mailbox and
// never waits for anybody: a client that does not take one gets a newer one later.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "app/page/page_message.h"

namespace brick {

class PageServer {
 public:
  using Client = std::uint64_t;
  static constexpr std::size_t kMostConnections = 32;  // the oldest that is no websocket yet makes room
  static constexpr std::size_t kMostViewers = 16;      // websockets
  static constexpr std::size_t kMostCommands = 16;     // of one client that are not answered yet

  struct Options {
    std::string place;  // HOST:PORT or PORT; port 0 takes a free one
    bool read_only = false;
    std::string about;  // JSON, the first message to each client
  };
  explicit PageServer(const Options& options);  // throws UsageError
  ~PageServer();
  std::string address() const;  // to be opened in a browser, with its token
  bool beyond_loopback() const;

  // On the server's thread.
  std::function<void(Client)> on_open, on_close;
  std::function<void(Client, const PageCommand&)> on_command;  // never when read only
  std::function<void(Client, const PageWatch&)> on_watch;

  void start();
  void stop();  // and close all

  // From any thread.
  std::size_t viewers() const;
  double processor_seconds() const;              // that its thread has used
  void publish(std::string state);               // to all; a newer state takes the place of one not sent yet
  void answer(Client client, std::string text);  // to a command

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace brick
