// The communications processor of a Brick: what stands between its Ethernet connector and the host port. It forwards
// what clients ask for and knows no more of the controller's language than where an answer ends (ethernet:3 to
// ethernet:7). It waits for the board's request lines: clients that are idle cost no bus cycle.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "testbench/host/controller_dialogue.h"
#include "testbench/host/dpram_bytes.h"
#include "testbench/host/ethernet_packet.h"
#include "testbench/host/output_queue.h"

namespace brick {

class CommunicationsProcessor {
 public:
  using Client = std::uint64_t;
  struct Options {
    std::uint32_t dpram_words = 32768;
    bool save_takes_long = false;  // SAVE is answered NUL before it is over
  };
  static constexpr char kFactoryAddress[] = {'\xC0', 6, 94, 5};

  CommunicationsProcessor(HostBus& bus, const Options& options);

  bool start(Tick timeout) { return dialogue_.start(timeout); }  // waits for the firmware; false: it does not answer

  // Each request gets one reply, the replies of a client come in the order of its requests. Who has not been heard of
  // is a new client.
  void request(Client client, const EthernetPacket& packet);
  void close(Client client);  // nothing is replied to it any more
  std::function<void(Client, std::string)> on_reply;

  // Simulated time for one of the time of clients, at most 1. A fetch for which there is nothing waits half a second of
  // theirs, because nothing but time can answer it; a controller has its own for an answer.
  void set_speed(double speed);

  bool busy() const { return waiting_ > 0 || dialogue_.busy() || dialogue_.sends_at_once(); }
  void run_until(Tick limit);

  std::string address() const { return address_; }  // four bytes, as in the packet
  void set_address(const std::string& bytes) { address_ = bytes; }
  std::function<void(const std::string&)> on_address;  // a client has set it

 private:
  struct Request {
    EthernetPacket packet;
    bool done = false;  // carried out when it came; the reply waits for its turn
  };
  struct State {
    OutputQueue output;
    std::deque<Request> requests;
    bool started = false;  // the first of them is under way
    bool joined = false;   // its answer is that of several lines
    Tick since = 0;        // when it became the first, or the last text came
    std::string write_result = std::string(4, '\0');
  };

  bool has_lines_to_come(Client id, const State& client) const;
  bool serve();
  bool serve(Client id, State& client);
  bool carry_out(Client id, State& client, const EthernetPacket& packet);
  bool finish(Client id, State& client, const std::string& reply);  // true: it has been replied to
  bool dialogue_request(Client id, State& client, const EthernetPacket& packet);
  bool fetch(Client id, State& client, bool whole_answer);
  void begin_lines(Client id, const std::vector<std::string>& lines, bool stop_at_error);
  void own(Client id, bool keeps_text);
  bool is_under_way(Client id) const { return dialogue_.busy() && owner_ == id; }
  std::string control_answer();
  std::string port(const EthernetPacket& packet);
  std::string memory(const EthernetPacket& packet);
  std::string identity(const EthernetPacket& packet);
  void text(std::string_view text);
  void take_turn();
  Tick next_deadline(Tick limit) const;

  HostBus& bus_;
  const Options options_;
  ControllerDialogue dialogue_;
  DpramBytes dpram_;
  std::map<Client, State> clients_;
  std::size_t waiting_ = 0;  // requests
  Tick fetch_patience_;      // of a fetch when there is nothing
  Client owner_ = 0;         // of the job under way, or of the last one
  bool keeps_text_ = true;   // of that job
  std::string control_text_;
  Client turn_ = 0;  // the client after this one is served next
  std::string address_{kFactoryAddress, 4};
};

}  // namespace brick
