#include "app/page/page.h"

#include <time.h>
#include <algorithm>
#include <set>
#include <utility>

#include "app/build_info.h"
#include "app/byte_text.h"

namespace brick {

using nlohmann::json;

namespace {

PageServer::Options with_about(PageServer::Options options, const MachineConfig& config) {
  options.about = json{{"kind", "about"},
                       {"version", build_info()["version"]},
                       {"board", config.board.name},
                       {"engine", engine_name(config.engine)},
                       {"read_only", options.read_only}}
                      .dump();
  return options;
}

double processor_seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

// Without the bytes that frame it.
std::vector<std::string> lines_of(const std::string& answer) {
  std::vector<std::string> lines;
  std::string line;
  for (const char c : answer) {
    if (c == '\r') lines.push_back(utf8_text(std::exchange(line, {})));
    if (c >= ' ' || c < 0) line.push_back(c);
  }
  if (!line.empty()) lines.push_back(utf8_text(line));
  return lines;
}

}  // namespace

Page::Page(const PageServer::Options& options, Simulation& simulation, const MachineConfig& config,
           CommunicationsProcessor& processor, SimulationLoop& loop)
    : loop_(loop),
      machine_(simulation.machine()),
      server_(with_about(options, config)),
      snapshot_(simulation, config.firmware),
      port_(processor) {
  server_.on_open = [this](PageServer::Client) { loop_.post([this] { wanted_ = true; }); };
  server_.on_close = [this](PageServer::Client client) {
    const std::lock_guard<std::mutex> lock(mailbox_);
    lists_.erase(client);
    loop_.post([this, client] {
      port_.close(PagePort::kFirst + client);
      watched_.erase(client);
    });
  };
  server_.on_command = [this](PageServer::Client client, const PageCommand& one) {
    loop_.post([this, client, one] { command(client, one); });
  };
  server_.on_watch = [this](PageServer::Client client, const PageWatch& watch) {
    const std::lock_guard<std::mutex> lock(mailbox_);
    lists_[client] = watch.items;
  };
  loop_.on_turn = [this] { turn(); };
}

Page::~Page() { loop_.on_turn = nullptr; }

// Between two pieces of simulated time.
void Page::turn() {
  if (server_.viewers() == 0) return;
  const double begin = processor_seconds(CLOCK_THREAD_CPUTIME_ID);
  show();
  taken_ += processor_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
}

// Snapshots take half of the wall's time at most.
void Page::show() {
  snapshot_.sample();
  const auto wall = std::chrono::steady_clock::now();
  if (wall < next_) return;
  watch_all();
  if (!wanted_ && machine_.now() == shown_) return;
  shown_ = machine_.now();
  wanted_ = false;
  json state = snapshot_.take();
  state["cost"] = cost();
  server_.publish(state.dump());
  const auto end = std::chrono::steady_clock::now();
  next_ = end + std::max<std::chrono::steady_clock::duration>(kEvery, end - wall);
}

// Processor seconds so far: of what reads and sends states, and of the whole process.
json Page::cost() const {
  return {{"page", taken_ + server_.processor_seconds()}, {"all", processor_seconds(CLOCK_PROCESS_CPUTIME_ID)}};
}

void Page::command(PageServer::Client client, const PageCommand& command) {
  port_.command(PagePort::kFirst + client, command.line, [this, client, command](const std::string& answer) {
    server_.answer(client, json{{"kind", "answer"},
                                {"id", command.id},
                                {"line", command.line},
                                {"lines", lines_of(answer)},
                                {"refused", answer.find('\x07') != std::string::npos},
                                {"cut", answer.size() >= PagePort::kLongestAnswer}}
                               .dump());
  });
}

// Each of what anybody watches, once.
void Page::watch_all() {
  std::map<PageServer::Client, std::vector<std::string>> lists;
  {
    const std::lock_guard<std::mutex> lock(mailbox_);
    lists.swap(lists_);
  }
  if (!lists.empty()) wanted_ = true;
  for (auto& [client, list] : lists) watched_[client] = std::move(list);
  std::set<std::string> items;
  for (const auto& [client, list] : watched_) items.insert(list.begin(), list.end());
  snapshot_.watch(items);
}

}  // namespace brick
