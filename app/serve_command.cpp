// `brick serve`: a started controller behind the Ethernet port of a Brick (docs/ethernet.md).
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <regex>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/build_info.h"
#include "app/byte_text.h"
#include "app/commands.h"
#include "app/complaint.h"
#include "app/ethernet_server.h"
#include "app/page/page.h"
#include "app/session_end.h"
#include "app/set_up.h"
#include "app/simulation.h"
#include "app/simulation_loop.h"
#include "systemc/core/input_file.h"
#include "systemc/core/usage_error.h"
#include "testbench/host/communications_processor.h"

namespace brick {

namespace {

// The interface keeps its address in a memory of its own: beside the flash file, if there is one.
class AddressFile {
 public:
  explicit AddressFile(const std::string& flash) : name_(flash.empty() ? "" : flash + ".address") {}

  // Four bytes; "" when there is none.
  std::string read() const {
    constexpr const char* kExpected = "four numbers up to 255 with dots between them";
    std::error_code none;
    if (name_.empty() || !std::filesystem::exists(name_, none)) return "";
    const std::string text = read_input_file(name_, kExpected);
    static const std::regex kForm(R"((\d{1,3})\.(\d{1,3})\.(\d{1,3})\.(\d{1,3})\s*)");
    std::smatch numbers;
    std::string address;
    if (text.size() <= kLongest && std::regex_match(text, numbers, kForm))
      for (std::size_t n = 1; n <= 4; ++n)
        if (const int number = std::stoi(numbers[n]); number <= UINT8_MAX) address.push_back(static_cast<char>(number));
    if (address.size() != 4) throw UsageError(fmt::format("{}: is no address; expected {}", name_, kExpected));
    return address;
  }

  // Whether it is kept; else the old one stays.
  bool write(const std::string& address) const {
    if (name_.empty()) return true;
    const auto byte = [&](std::size_t n) { return static_cast<unsigned>(static_cast<unsigned char>(address[n])); };
    const std::string other = name_ + ".new";
    std::ofstream out(other);
    out << fmt::format("{}.{}.{}.{}\n", byte(0), byte(1), byte(2), byte(3));
    out.close();
    std::error_code failed;
    if (out) std::filesystem::rename(other, name_, failed);
    return out && !failed;
  }
  const std::string& name() const { return name_; }

 private:
  static constexpr std::size_t kLongest = 64;
  std::string name_;
};

void show(Page& page, const std::function<void(const std::string&)>& tell) {
  std::cout << "page at " << page.server().address() << std::endl;
  if (page.server().beyond_loopback())
    tell(
        "the page is reached from other machines: nothing of it is encrypted, its address is its only key, and the "
        "Ethernet port has no password");
  page.start();
}

}  // namespace

int serve_command(const ServeOptions& options) {
  const MachineConfig config = machine_config(options.run);
  const AddressFile address_file(options.run.flash);
  const std::string address = address_file.read();
  const SetUp set_up(options.run);
  EthernetServer server(options.listen);
  Simulation simulation(options.run, config, "serve");
  simulation.end_with(options.end_with);
  set_up.check(simulation);
  CommunicationsProcessor processor(simulation.bus(), {config.board.dpram_words, options.save_takes_long});
  SimulationLoop loop(simulation.bus(), options.free);
  if (!address.empty()) processor.set_address(address);
  const auto tell = [&](const std::string& text) { simulation.tell("brick serve: " + text); };
  Complaint lost_address;
  processor.on_address = [&](const std::string& bytes) {
    if (address_file.write(bytes)) return;
    const std::string text = lost_address.text(fmt::format(
        "{}: cannot be written, the address is lost at the end; expected a writable place", address_file.name()));
    if (!text.empty()) tell(text);
  };
  server.on_request = [&](EthernetServer::Client client, const EthernetPacket& packet) {
    loop.post([&processor, client, packet] { processor.request(client, packet); });
  };
  server.on_close = [&](EthernetServer::Client client) {
    loop.post([&processor, client] { processor.close(client); });
  };
  server.on_trouble = [&](const std::string& text) { loop.post([&, text] { tell(text); }); };
  std::unique_ptr<Page> page;
  if (!options.page.empty())
    page = std::make_unique<Page>(PageServer::Options{options.page, options.page_read_only, ""}, simulation, config,
                                  processor, loop);
  simulation.progress_text = [&] { return fmt::format(", {} of {} clients", server.clients(), server.kMostClients); };

  processor.on_reply = [&](EthernetServer::Client client, std::string bytes) {
    if (PagePort::is_page(client)) return page->reply(client, bytes);
    server.reply(client, std::move(bytes));
  };

  std::vector<std::string> failures;
  try {
    simulation.run([&] {
      if (!set_up.empty()) {
        connect_at_start(simulation);
        set_up.send(simulation);
      }
      if (!processor.start(HostLink::kBootTime))
        throw std::runtime_error(
            fmt::format("the controller does not answer after power-on: {}; expected an answer within 500 ms, see "
                        "--jumper E3",
                        no_answer(simulation)));
      std::cout << fmt::format("listening on {}, TCP and UDP", server.place()) << std::endl;
      if (page) show(*page, tell);
      server.start();
      loop.on_speed = [&](double speed) { processor.set_speed(speed); };
      loop.run([&] { return processor.busy(); }, [&](Tick limit) { processor.run_until(limit); });
    });
  } catch (const Interrupted& e) { tell(e.what()); } catch (const std::exception& e) {
    failures.emplace_back(e.what());
  }
  server.stop();
  if (page) page->stop();
  const Simulation::TimingVerdict timing = simulation.timing_verdict();
  for (const auto& list : {simulation.machine().take_run_errors(), timing.failures})
    failures.insert(failures.end(), list.begin(), list.end());
  for (const auto* list : {&std::as_const(failures), &timing.waived, &timing.unused})
    for (const std::string& text : *list) tell(text);
  if (!options.run.json.empty()) {
    nlohmann::json results = simulation.measures();
    results["engine"] = options.run.engine;
    results["board"] = config.board.name;
    results["seed"] = config.seed;
    results["passed"] = failures.empty();
    if (!failures.empty()) results["failure"] = utf8_text(failures.front());
    results["failures"] = failures_json(failures);
    add_origin(results, config.firmware);
    write_json(options.run.json, results);
  }
  return failures.empty() ? 0 : 1;
}

}  // namespace brick
