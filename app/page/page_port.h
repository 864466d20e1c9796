// The page as one more client of the Ethernet port: its lines take turns with those of all others, and what they are
// answered is theirs alone (docs/ethernet.md). On the simulation's thread.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <string>

#include "testbench/host/communications_processor.h"

namespace brick {

class PagePort {
 public:
  using Client = CommunicationsProcessor::Client;
  static constexpr Client kFirst = Client{1} << 62;  // those below are the Ethernet server's
  static constexpr std::size_t kLongestAnswer = 64 << 10;

  explicit PagePort(CommunicationsProcessor& processor) : processor_(processor) {}

  static bool is_page(Client client) { return client >= kFirst; }

  // `done` is told the answer as the controller has framed it; of one longer than kLongestAnswer its beginning.
  void command(Client client, const std::string& line, std::function<void(std::string answer)> done);
  void reply(Client client, const std::string& bytes);  // of the processor
  void close(Client client);

 private:
  struct Waiting {
    std::string line, answer;
    std::function<void(std::string)> done;
    bool flushes = false;
  };
  void begin(Client client);

  CommunicationsProcessor& processor_;
  std::map<Client, std::deque<Waiting>> waiting_;  // the first is under way
};

}  // namespace brick
