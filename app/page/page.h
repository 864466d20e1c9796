// A page to look at a served controller (`brick serve --page`, docs/page.md): joins what is read of the machine, the
// sockets, and the port for what the page's buttons and terminal say.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "app/page/page_port.h"
#include "app/page/page_server.h"
#include "app/page/snapshot.h"
#include "app/simulation_loop.h"

namespace brick {

class Page {
 public:
  static constexpr std::chrono::milliseconds kEvery{50};  // of the wall, between two snapshots

  // Takes on_turn of the loop. All that is given lives longer.
  Page(const PageServer::Options& options, Simulation& simulation, const MachineConfig& config,
       CommunicationsProcessor& processor, SimulationLoop& loop);
  ~Page();
  Page(const Page&) = delete;

  void start() { server_.start(); }
  void stop() { server_.stop(); }
  const PageServer& server() const { return server_; }
  void reply(PagePort::Client client, const std::string& bytes) { port_.reply(client, bytes); }

 private:
  void turn();
  void show();
  nlohmann::json cost() const;
  void command(PageServer::Client client, const PageCommand& command);
  void watch_all();

  SimulationLoop& loop_;
  Machine& machine_;
  PageServer server_;
  Snapshot snapshot_;
  PagePort port_;
  std::map<PageServer::Client, std::vector<std::string>> watched_;
  std::mutex mailbox_;
  std::map<PageServer::Client, std::vector<std::string>> lists_;  // in the mailbox: the newest of each client
  std::chrono::steady_clock::time_point next_;
  Tick shown_ = -1;
  double taken_ = 0;     // by turns, of the simulation's thread, in processor seconds
  bool wanted_ = false;  // by somebody who has none yet
};

}  // namespace brick
