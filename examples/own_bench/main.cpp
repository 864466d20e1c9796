// A testbench of one's own on the installed package: an encoder at a channel of the servo IC turns at random by --seed,
// a scoreboard written from the data sheet alone says where the counter stands, and the verdict goes to --json as
// `brick run` has it, so that `brick regress` shows steps and covers (plan.toml). --wave FILE: all pins. --negative: a
// scoreboard with a wrong rule, with which the bench must fail. Exit status 0, 1, 2 as brick's.
#include <brick/servo_ic.h>
#ifdef WITH_RTL
#include <brick/rtl.h>
#endif
#include <tlm_utils/simple_initiator_socket.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <random>
#include <sstream>
#include <string>

using namespace brick::component;
using sc_core::sc_time;

// servo-ic:5.4: four counts a line, up while A leads B.
class Scoreboard {
 public:
  explicit Scoreboard(bool wrong) : per_edge_(wrong ? 2 : 1) {}
  void turn(bool up) { count_ += up ? per_edge_ : -per_edge_; }
  std::uint32_t expected() const { return static_cast<std::uint32_t>(count_) & 0xFFFFFF; }

 private:
  const int per_edge_;
  int count_ = 0;
};

struct Step {
  sc_time at;
  std::string name, detail;
  bool passed;
};

struct Bench : sc_core::sc_module {
  tlm_utils::simple_initiator_socket<Bench> socket{"socket"};
  sc_core::sc_out<bool> a{"a"}, b{"b"};
  std::vector<Step> steps;
  std::map<std::string, unsigned> covers{{"edges up", 0}, {"edges down", 0}, {"turns", 0}, {"reads below 0", 0}};

  Bench(sc_core::sc_module_name name, unsigned long seed, bool wrong)
      : sc_module(name), random_(seed), scoreboard_(wrong) {
    SC_HAS_PROCESS(Bench);
    SC_THREAD(run);
  }

 private:
  static constexpr unsigned kControl = 8 * 0x05 + 4, kPosition = 8 * 0x01 + 4, kClocks = 8 * 0x04 + 4;  // servo-ic:2.1

  std::uint32_t access(tlm::tlm_command command, unsigned address, std::uint32_t value = 0) {
    tlm::tlm_generic_payload payload;
    payload.set_command(command);
    payload.set_address(address);
    payload.set_data_ptr(reinterpret_cast<unsigned char*>(&value));
    payload.set_data_length(4);
    payload.set_streaming_width(4);
    sc_time delay;
    socket->b_transport(payload, delay);
    if (payload.is_response_error()) SC_REPORT_ERROR(name(), payload.get_response_string().c_str());
    return value;
  }
  unsigned any(unsigned least, unsigned most) { return std::uniform_int_distribution<unsigned>(least, most)(random_); }

  void edge(bool up) {
    place_ += up ? 1 : 3;
    a->write(place_ % 4 == 1 || place_ % 4 == 2);
    b->write(place_ % 4 == 2 || place_ % 4 == 3);
    scoreboard_.turn(up);
    ++covers[up ? "edges up" : "edges down"];
    wait(any(200, 1500), sc_core::SC_NS);  // the input filter takes 102 ns
  }

  void run() {
    constexpr unsigned kRounds = 20;
    access(tlm::TLM_WRITE_COMMAND, kClocks, 0x0008D2);
    access(tlm::TLM_WRITE_COMMAND, kControl, 0x000003);  // times 4
    wait(1, sc_core::SC_US);
    bool before = true;
    for (unsigned round = 1; round <= kRounds; ++round) {
      const bool up = round == kRounds ? !before : any(0, 1) != 0;  // it turns in every run
      covers["turns"] += round > 1 && up != before;
      before = up;
      for (unsigned n = any(1, 30); n > 0; --n) edge(up);
      wait(250, sc_core::SC_US);  // the phase position is taken at PHASE
      const std::uint32_t measured = access(tlm::TLM_READ_COMMAND, kPosition) & 0xFFFFFF;
      covers["reads below 0"] += measured >> 23;
      std::ostringstream detail;
      detail << measured << ", expected " << scoreboard_.expected();
      steps.push_back({sc_core::sc_time_stamp(), "position after round " + std::to_string(round), detail.str(),
                       measured == scoreboard_.expected()});
    }
    sc_core::sc_stop();
  }

  std::mt19937_64 random_;
  Scoreboard scoreboard_;
  unsigned place_ = 0;
};

long ns(const sc_time& time) { return std::lround(time.to_seconds() * 1e9); }

// The keys of `brick run --json` that `brick regress` reads.
bool write_json(const std::string& file, const Bench& bench, unsigned long seed, bool passed) {
  std::ofstream out(file);
  out << "{\"bench\": \"own_bench\", \"seed\": " << seed << ", \"verdict\": \"" << (passed ? "PASS" : "FAIL")
      << "\", \"simulated_ns\": " << ns(sc_core::sc_time_stamp()) << ",\n \"steps\": [";
  for (std::size_t i = 0; i < bench.steps.size(); ++i)
    out << (i == 0 ? "" : ",") << "\n  {\"ns\": " << ns(bench.steps[i].at) << ", \"name\": \"" << bench.steps[i].name
        << "\", \"passed\": " << (bench.steps[i].passed ? "true" : "false") << ", \"detail\": \""
        << bench.steps[i].detail << "\"}";
  out << "],\n \"covers\": {";
  const char* between = "";
  for (const auto& [name, count] : bench.covers) {
    out << between << "\n  \"own_bench: " << name << "\": {\"count\": " << count << ", \"least\": 1}";
    between = ",";
  }
  out << "}}\n";
  return out.good();
}

int usage(const std::string& word) {
  std::cerr << "own_bench: " << word
            << "; expected [--seed N] [--engine model|rtl] [--json FILE] [--wave NAME] [--negative]\n";
  return 2;
}

int sc_main(int count, char* arguments[]) {
  std::map<std::string, std::string> options{{"--seed", "1"}, {"--engine", "model"}, {"--json", ""}, {"--wave", ""}};
  bool negative = false;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    if (word == "--negative")
      negative = true;
    else if (options.count(word) == 0 || i + 1 == count)
      return usage(word);
    else
      options[word] = arguments[++i];
  }
  Engine engine = model_engine();
  if (options["--engine"] == "rtl") {
#ifdef WITH_RTL
    engine = rtl_engine();
#else
    return usage("--engine rtl: the package has no RTL");
#endif
  } else if (options["--engine"] != "model") {
    return usage("--engine " + options["--engine"]);
  }
  const std::string& number = options["--seed"];
  if (number.empty() || number.size() > 19 || number.find_first_not_of("0123456789") != std::string::npos)
    return usage("--seed " + number + ": is no number");
  const unsigned long seed = std::stoul(number);

  TimeBase time("time");
  ServoIc ic("ic", time, engine);
  Bench bench("bench", seed, negative);
  sc_core::sc_signal<bool> a("a"), b("b");
  bench.socket.bind(ic.registers);
  bench.a(a), bench.b(b), ic.ch[0].enc_a(a), ic.ch[0].enc_b(b);
  sc_core::sc_trace_file* wave = nullptr;
  if (!options["--wave"].empty()) {
    wave = sc_core::sc_create_vcd_trace_file(options["--wave"].c_str());  // adds .vcd
    sc_trace(wave, ic, "ic");
  }
  sc_core::sc_start();
  if (wave != nullptr) sc_core::sc_close_vcd_trace_file(wave);

  bool passed = !bench.steps.empty();
  for (const Step& step : bench.steps) {
    std::cout << step.at << (step.passed ? "  ok    " : "  FAIL  ") << step.name << ": " << step.detail << "\n";
    passed = passed && step.passed;
  }
  std::cout << (passed ? "PASS" : "FAIL") << " own_bench, seed " << seed << "\n";
  if (!options["--json"].empty() && !write_json(options["--json"], bench, seed, passed))
    return usage("--json " + options["--json"] + ": cannot be written");
  return passed ? 0 : 1;
}
