#include "testbench/host/communications_processor.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "testbench/host/framing_probe.h"

namespace brick {

namespace {

using Packet = EthernetPacket;

constexpr Tick kFetchPatience = ns_to_ticks(500'000'000);  // of a fetch when there is nothing
constexpr Tick kFlushWait = ns_to_ticks(10'000'000), kLongestFlush = ns_to_ticks(500'000'000);
constexpr Tick kTurn = ns_to_ticks(500'000);
constexpr std::uint32_t kIoBytes = 16;
constexpr std::uint8_t kClear = 0x18;
constexpr char kNothing[] = {'\0'}, kExecuted[] = {'\x06'};

// ^A ^D ^K ^O ^Q wait for nobody.
bool is_stop(std::uint8_t c) { return c == 0x01 || c == 0x04 || c == 0x0B || c == 0x0F || c == 0x11; }

// A client that forgets the byte order has the character in the high byte.
std::uint8_t control_of(const Packet& packet) {
  const unsigned low = packet.value & 0xFF;
  return static_cast<std::uint8_t>(low != 0 ? low : packet.value >> 8);
}

bool is_control(const Packet& packet) {
  return packet.request == Packet::kSendControl || packet.request == Packet::kControlResponse;
}

bool is_text(const Packet& packet) {
  return packet.request == Packet::kSendLine || packet.request == Packet::kGetResponse ||
         packet.request == Packet::kWriteBuffer;
}

// Those of a packet, in their order.
std::string stops_of(const Packet& packet) {
  std::string stops;
  if (is_control(packet) && is_stop(control_of(packet))) stops.push_back(static_cast<char>(control_of(packet)));
  if (!is_text(packet)) return stops;
  std::copy_if(packet.data.begin(), packet.data.end(), std::back_inserter(stops),
               [](char c) { return is_stop(static_cast<std::uint8_t>(c)); });
  return stops;
}

// Those of its first line have been carried out; those of the others come behind a line as well.
void take_stops_of_first_line(Packet& packet) {
  const char separator = packet.request == Packet::kWriteBuffer ? '\0' : '\r';
  std::string& text = packet.data;
  const auto end = std::find(text.begin(), text.end(), separator);
  text.erase(std::remove_if(text.begin(), end, [](char c) { return is_stop(static_cast<std::uint8_t>(c)); }), end);
}

bool begins_job(const Packet& packet) {
  switch (packet.request) {
    case Packet::kSendLine:
    case Packet::kGetResponse:
    case Packet::kWriteBuffer:
    case Packet::kFlush:
    case Packet::kPort:
    case Packet::kSendControl:
    case Packet::kControlResponse:
      return true;
    default:
      return false;
  }
}

constexpr std::string_view kBlank("\r\n \0", 4);

// Lines of text, without what clients put behind the last one.
std::vector<std::string> lines_of(std::string text, char separator) {
  const std::size_t last = text.find_last_not_of(kBlank);
  text.erase(last == std::string::npos ? 0 : last + 1);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

std::string echo(const Packet& packet) { return std::string(1, static_cast<char>(packet.type)); }

}  // namespace

CommunicationsProcessor::CommunicationsProcessor(HostBus& bus, const Options& options)
    : bus_(bus), options_(options), dialogue_(bus), dpram_(bus, options.dpram_words), fetch_patience_(kFetchPatience) {
  dialogue_.on_text = [this](std::string_view more) { text(more); };
}

void CommunicationsProcessor::set_speed(double speed) {
  fetch_patience_ =
      std::max(ControllerDialogue::kQuiet, static_cast<Tick>(speed * static_cast<double>(kFetchPatience)));
}

// ------------------------------------------------------------------------------------------------------------- clients

void CommunicationsProcessor::request(Client client, const EthernetPacket& packet) {
  State& state = clients_[client];
  Request request{packet, false};
  const std::string stops = stops_of(packet);
  for (const char stop : stops) dialogue_.send_at_once(static_cast<std::uint8_t>(stop));
  if (!stops.empty() && !has_lines_to_come(client, state)) {
    request.done = is_control(packet);
    take_stops_of_first_line(request.packet);
  }
  if (packet.request == Packet::kFlush && is_under_way(client)) {
    state.output.clear();
    dialogue_.abandon();
  }
  if (state.requests.empty()) state.since = bus_.now();
  state.requests.push_back(std::move(request));
  ++waiting_;
}

// That the client has asked for and the controller has not got: what stops things stops those, too, in its turn.
bool CommunicationsProcessor::has_lines_to_come(Client id, const State& client) const {
  if (is_under_way(id) && dialogue_.has_lines_to_send()) return true;
  const auto first = client.requests.begin() + (client.started ? 1 : 0);
  return std::any_of(first, client.requests.end(), [](const Request& request) {
    return is_text(request.packet) && request.packet.data.find_first_not_of(kBlank) != std::string::npos;
  });
}

void CommunicationsProcessor::close(Client client) {
  const auto found = clients_.find(client);
  if (found == clients_.end()) return;
  waiting_ -= found->second.requests.size();
  clients_.erase(found);
}

// What no job has asked for (SEND in programs) goes to the client that has talked last.
void CommunicationsProcessor::text(std::string_view text) {
  if (!keeps_text_ && dialogue_.busy()) {
    if (control_text_.size() < Packet::kMostReply) control_text_ += text;
    return;
  }
  const auto found = clients_.find(owner_);
  if (found == clients_.end()) return;
  found->second.output.add(text);
  found->second.since = bus_.now();
}

void CommunicationsProcessor::own(Client id, bool keeps_text) {
  owner_ = id;
  keeps_text_ = keeps_text;
  control_text_.clear();
}

// ------------------------------------------------------------------------------------------------------------ requests

// One request of each client; whoever has had the controller's attention comes last. But a job that has ended is
// replied to first: how it ended is known until the next one begins.
bool CommunicationsProcessor::serve() {
  const auto ended = clients_.find(owner_);
  bool some = ended != clients_.end() && ended->second.started && !dialogue_.busy() && serve(owner_, ended->second);
  auto at = clients_.upper_bound(turn_);
  for (std::size_t n = clients_.size(); n > 0 && waiting_ > 0; --n, ++at) {
    if (at == clients_.end()) at = clients_.begin();
    if (at->second.requests.empty()) continue;
    const bool idle = !dialogue_.busy();
    some = serve(at->first, at->second) || some;
    if (idle && dialogue_.busy()) turn_ = at->first;
  }
  return some;
}

// True when the client's first request has been replied to.
bool CommunicationsProcessor::serve(Client id, State& client) {
  const Request& first = client.requests.front();
  const Packet& packet = first.packet;
  if (first.done)
    return finish(id, client, packet.request == Packet::kControlResponse ? std::string(kExecuted, 1) : echo(packet));
  if (begins_job(packet) && !client.started && dialogue_.busy()) {
    if (!(packet.request == Packet::kFlush && is_under_way(id))) return false;
    dialogue_.abandon();
  }
  return carry_out(id, client, packet);
}

bool CommunicationsProcessor::finish(Client id, State& client, const std::string& reply) {
  client.requests.pop_front();
  --waiting_;
  client.started = false;
  client.since = bus_.now();
  on_reply(id, reply);
  return true;
}

bool CommunicationsProcessor::carry_out(Client id, State& client, const EthernetPacket& packet) {
  switch (packet.request) {
    case Packet::kGetLine:
      return fetch(id, client, false);
    case Packet::kGetBuffer:
      return fetch(id, client, true);
    case Packet::kReadReady:
      return finish(id, client, {static_cast<char>(client.output.empty() ? 0 : 1), '\0'});
    case Packet::kGetMemory:
    case Packet::kSetMemory:
    case Packet::kSetBit:
    case Packet::kSetBits:
      return finish(id, client, memory(packet));
    case Packet::kPort:
      return finish(id, client, port(packet));
    case Packet::kWriteError:
      return finish(id, client, client.write_result);
    case Packet::kDownloadFirmware:
      return finish(id, client, echo(packet));
    case Packet::kAddress:
    case Packet::kHardwareAddress:
    case Packet::kDate:
    case Packet::kTime:
    case Packet::kVersion:
      return finish(id, client, identity(packet));
    default:
      return dialogue_request(id, client, packet);
  }
}

// What takes the controller's time: begun, and asked again until its job is over.
bool CommunicationsProcessor::dialogue_request(Client id, State& client, const EthernetPacket& packet) {
  const bool begins = !std::exchange(client.started, true);
  switch (packet.request) {
    case Packet::kFlush:
      if (begins) {
        client.output.clear();
        own(id, true);
        const Tick wait = ns_to_ticks(std::int64_t{packet.value} * 1'000'000);
        dialogue_.begin_clear(packet.value == 0 ? kFlushWait : std::min(wait, kLongestFlush));
      }
      if (is_under_way(id)) return false;
      return finish(id, client, echo(packet));
    case Packet::kSendLine:
      begin_lines(id, lines_of(packet.data, '\r'), false);
      return finish(id, client, echo(packet));
    case Packet::kGetResponse:
      if (begins) {
        const std::vector<std::string> lines = lines_of(packet.data, '\r');
        client.joined = lines.size() > 1;
        client.output.clear();
        begin_lines(id, lines, false);
        if (!options_.save_takes_long || !may_take_long(packet.data)) return false;
        return finish(id, client, std::string(kNothing, 1));
      }
      return fetch(id, client, !client.joined);
    case Packet::kWriteBuffer: {
      if (begins) {
        own(id, false);
        std::string text = packet.data;
        std::replace(text.begin(), text.end(), '\r', ' ');
        dialogue_.begin_lines(lines_of(text, '\0'), true);
      }
      if (is_under_way(id)) return false;
      const ControllerDialogue::Result& result = dialogue_.result();
      const std::size_t line = result.lines + (result.lost ? 1 : 0);
      client.write_result = std::string(4, '\0');
      if (result.error || result.lost)
        client.write_result = {static_cast<char>(line), static_cast<char>(line >> 8),
                               static_cast<char>(result.error_number), '\x80'};
      return finish(id, client, client.write_result);
    }
    default: {  // a control character
      const std::uint8_t c = control_of(packet);
      const bool answers = packet.request == Packet::kControlResponse;
      if (begins && is_answered_control(c)) {
        own(id, !answers);
        dialogue_.begin_control(c);
      } else if (begins && c == kClear) {
        own(id, true);
        dialogue_.begin_clear(kFlushWait);
      } else if (begins && c < 0x20 && c != 0) {
        dialogue_.send_at_once(c);
      }
      if (answers && is_under_way(id)) return false;
      return finish(id, client,
                    !answers               ? echo(packet)
                    : is_report_control(c) ? control_answer()
                                           : std::string(kExecuted, 1));
    }
  }
}

void CommunicationsProcessor::begin_lines(Client id, const std::vector<std::string>& lines, bool stop_at_error) {
  own(id, true);
  dialogue_.begin_lines(lines, stop_at_error);
}

// `whole_answer`: as GETRESPONSE and GETBUFFER stop, else as GETLINE does; of several lines together, at their end.
bool CommunicationsProcessor::fetch(Client id, State& client, bool whole_answer) {
  const bool answering = client.requests.front().packet.request == Packet::kGetResponse;
  const bool joined = answering && client.joined;
  std::optional<std::string> text;
  if (joined) {
    if (client.output.size() >= Packet::kMostReply) text = client.output.take(Packet::kMostReply);
  } else {
    text = whole_answer ? client.output.take_answer(Packet::kMostReply) : client.output.take_line(Packet::kMostReply);
  }
  if (!text) {
    if (is_under_way(id)) return false;
    const Tick patience = client.output.empty() ? fetch_patience_ : ControllerDialogue::kQuiet;
    if (!answering && bus_.now() < client.since + patience) return false;
    text = client.output.take(Packet::kMostReply);
  }
  return finish(id, client, text->empty() ? std::string(kNothing, 1) : *text);
}

// One line, without the controller's acknowledge.
std::string CommunicationsProcessor::control_answer() {
  std::string text = std::move(control_text_);
  control_text_.clear();
  text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\x06'; }), text.end());
  if (text.empty()) return std::string(kNothing, 1);
  if (text.back() != '\r') text += '\r';
  return text.substr(0, Packet::kMostReply);
}

std::string CommunicationsProcessor::memory(const EthernetPacket& packet) {
  switch (packet.request) {
    case Packet::kGetMemory:
      return dpram_.read(packet.value, std::min<std::size_t>(packet.length, Packet::kMostReply));
    case Packet::kSetMemory:
      dpram_.write(packet.value, packet.data);
      break;
    case Packet::kSetBit:
      if (packet.data.size() < 4) break;
      if (packet.index == 0)
        dpram_.change_bits(packet.value, 0, ~little_endian(packet.data));
      else
        dpram_.change_bits(packet.value, little_endian(packet.data), 0);
      break;
    default:
      if (packet.data.size() < 8) break;
      dpram_.change_bits(packet.value, little_endian(packet.data),
                         little_endian(std::string_view(packet.data).substr(4)));
  }
  return echo(packet);
}

std::string CommunicationsProcessor::port(const EthernetPacket& packet) {
  if (packet.type == Packet::kUpload)
    return std::string(1, packet.value < kIoBytes ? static_cast<char>(bus_.io_read(packet.value)) : '\0');
  if (packet.value < kIoBytes) bus_.io_write(packet.value, static_cast<std::uint8_t>(packet.index));
  dialogue_.port().open();
  return echo(packet);
}

std::string CommunicationsProcessor::identity(const EthernetPacket& packet) {
  const auto padded = [](std::string text, std::size_t size) {
    text.resize(size, '\0');
    return text;
  };
  switch (packet.request) {
    case Packet::kHardwareAddress:
      return std::string("\x02\0\0\0\0\x01", 6);
    case Packet::kDate:
      return padded("01/01/04", 16);
    case Packet::kTime:
      return padded("00:00:00", 16);
    case Packet::kVersion:
      return padded("brick", 8);
    default:
      break;
  }
  if (packet.type == Packet::kDownload && packet.data.size() == 4) {
    address_ = packet.data;
    if (on_address) on_address(address_);
  }
  return address_;
}

// ---------------------------------------------------------------------------------------------------------------- time

Tick CommunicationsProcessor::next_deadline(Tick limit) const {
  for (const auto& [id, client] : clients_)
    if (!client.requests.empty())
      for (const Tick patience : {ControllerDialogue::kQuiet, fetch_patience_})
        if (client.since + patience > bus_.now()) limit = std::min(limit, client.since + patience);
  return limit;
}

// Time for the controller while there are always requests that need none of it, as those for memory: each of them takes
// time of the bus.
void CommunicationsProcessor::take_turn() {
  const Tick end = bus_.now() + kTurn;
  do { dialogue_.step(end); } while (dialogue_.busy() && bus_.now() < end);
}

void CommunicationsProcessor::run_until(Tick limit) {
  while (bus_.now() < limit) {
    while (bus_.now() < limit && serve())
      if (dialogue_.busy()) take_turn();
    const Tick until = next_deadline(limit);
    while (bus_.now() < until && !dialogue_.step(until)) {}
  }
}

}  // namespace brick
