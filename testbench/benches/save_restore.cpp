// save-restore: a host changes variables, definitions, axes, programs and the password, and SAVEs; the controller is
// started again by `$$$`, the reset line, INIT/ or the power, after the SAVE or at a random instant inside it. A
// scoreboard knows two contents, that of the last SAVE that counted and that of the SAVE under way: what comes back is
// all of the one or all of the other, and what was acknowledged is never lost (firmware:5.10, firmware:8.5).
#include <random>

#include <fmt/format.h>

#include "testbench/benches/benches.h"

namespace brick {
namespace {

constexpr Tick kMicrosecond = kPwmClockHz / 1'000'000;
constexpr Tick kMillisecond = kPwmClockHz / 1000;
constexpr unsigned kCuts = 4, kQuestions = 8;

// What a user keeps, of each kind something: the lines that set it, and the questions whose answers tell.
struct Content {
  std::vector<std::string> lines, answers;
};

const char* const kAsk[kQuestions] = {"I17 I122", "P10 P8191",     "&3Q7",        "M50->",
                                      "&2#3->",   "LIST PROG 900", "LIST PLC 17", "&2LIST FORWARD"};

Content make(std::mt19937_64& random) {
  const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
  const unsigned i17 = 11 + below(1000), speed = 1 + below(1000), p = 1 + below(1'000'000), q = 1 + below(1000),
                 address = 0x10000 + below(0x700), scale = 2 + below(9000), x = 1 + below(100000), f = below(8192);
  return {{fmt::format("I17={} I122={}.5", i17, speed), fmt::format("P10={}.25 P8191=-{}", p, p),
           fmt::format("&3Q7={}", q), fmt::format("M50->X:${:X},4,8", address), fmt::format("&2#3->{}Y+{}", scale, q),
           fmt::format("OPEN PROG 900 CLEAR X{}Y{} CLOSE", x, q),
           fmt::format("OPEN PLC 17 CLEAR P1=P{}*{} CLOSE", f, q), fmt::format("&2OPEN FORWARD CLEAR Q7=P{} CLOSE", f)},
          {fmt::format("{}|{}.5", i17, speed), fmt::format("{}.25|-{}", p, p), fmt::format("{}", q),
           fmt::format("X:${:X},4,8", address), fmt::format("{}Y+{}", scale, q), fmt::format("X{}Y{}|RET", x, q),
           fmt::format("P1=P{}*{}|RET", f, q), fmt::format("Q7=P{}|RET", f)}};
}

class SaveRestore {
 public:
  explicit SaveRestore(BenchContext& b) : b_(b), random_(b.seed) {}

  void run() {
    stored_ = make(random_);
    enter(stored_);
    const Tick begin = b_.bus.now();
    b_.expect("SAVE", "");
    duration_ = b_.bus.now() - begin;
    b_.report.step("SAVE", duration_ < 500 * kMillisecond, fmt::format("{:.1f} ms", ms(duration_)));
    if (b_.negative) stored_.answers[1] = "nobody's|values";
    resets();
    cuts();
    password();
  }

 private:
  static double ms(Tick ticks) { return static_cast<double>(ticks) / kMillisecond; }

  void enter(const Content& content) {
    for (const std::string& line : content.lines) {
      const std::string answer = b_.ask(line);
      if (!answer.empty()) b_.report.fail(line, answer + ", expected an acknowledge");
    }
  }

  // Questions whose answer is another one; the first of them.
  unsigned wrong(const Content& content, std::string* first) {
    unsigned count = 0;
    for (unsigned i = 0; i < kQuestions; ++i) {
      const std::string answer = b_.ask(kAsk[i]);
      ++compared_;
      if (answer == content.answers[i]) continue;
      if (count++ == 0) *first = fmt::format("{}: {}, expected {}", kAsk[i], answer, content.answers[i]);
    }
    return count;
  }

  bool connected(const std::string& how) {
    if (b_.link.connect(HostLink::kBootTime)) return true;
    b_.report.fail(how, "no answer, expected the firmware");
    return false;
  }

  void init() {
    b_.machine.inputs().jpan_init_n = false;
    b_.machine.apply();
    b_.bus.wait(100 * kMicrosecond);
    b_.machine.inputs().jpan_init_n = true;
    b_.machine.apply();
  }

  // 0 the reset line, 1 the power, 2 INIT/ where there is a panel.
  std::string start_again(unsigned how) {
    if (how == 2 && b_.board.jpan) {
      init();
      return "INIT/";
    }
    if (how == 1)
      b_.machine.power_cycle();
    else
      b_.machine.reset();
    return how == 1 ? "power" : "reset line";
  }

  void came_back(const std::string& how, const Content& content) {
    std::string first;
    const unsigned differ = wrong(content, &first);
    b_.report.step(how + ": what was SAVEd", differ == 0, differ == 0 ? fmt::format("{} answers", kQuestions) : first);
    if (const std::string problems = b_.problems(); problems != "none")
      b_.report.fail(how + ": ???", problems + ", expected none");
  }

  // After the acknowledge, with something else in memory that was not SAVEd.
  void resets() {
    for (unsigned how = 0; how < 4; ++how) {
      enter(make(random_));
      std::string name = "$$$";
      if (how == 3)
        b_.link.command("$$$");
      else
        name = start_again(how);
      if (!connected(name)) return;
      came_back(name, stored_);
    }
  }

  // SAVE is sent, and the controller started again a random time later: a quarter of a SAVE each, the last behind its
  // end, when the acknowledge has come.
  void cuts() {
    unsigned old_ones = 0, new_ones = 0;
    for (unsigned cut = 0; cut <= kCuts; ++cut) {
      const Content next = make(random_);
      enter(next);
      b_.link.send("SAVE");
      const Tick quarter = duration_ / kCuts;
      const Tick later = quarter * cut + static_cast<Tick>(random_() % static_cast<std::uint64_t>(quarter));
      const bool acknowledged = cut == kCuts && b_.link.finish(HostLink::kSaveTime).complete;
      if (cut < kCuts) b_.bus.wait(later);
      const std::string how = start_again(static_cast<unsigned>(random_() % 3));
      const std::string name = cut < kCuts ? "inside SAVE" : "behind SAVE";
      if (!connected(name)) return;
      std::string unlike_old, unlike_new;
      const unsigned old_wrong = wrong(stored_, &unlike_old), new_wrong = wrong(next, &unlike_new);
      const bool is_new = new_wrong == 0, is_old = old_wrong == 0 && !acknowledged;
      b_.report.step(name + ": all of the old or all of the new", is_new || is_old,
                     is_new || is_old ? fmt::format("{} after {:.3f} ms: {}", how, ms(later), is_new ? "new" : "old")
                                      : fmt::format("{} after {:.3f} ms: {}", how, ms(later),
                                                    acknowledged ? unlike_new : unlike_old));
      if (const std::string problems = b_.problems(); problems != "none")
        b_.report.fail(name + ": ???", problems + ", expected none");
      ++(is_new ? new_ones : old_ones);
      if (is_new) stored_ = next;
    }
    b_.report.step("both were seen", old_ones > 0 && new_ones > 0,
                   fmt::format("{} old, {} new, {} answers in all", old_ones, new_ones, compared_));
  }

  void password() {
    b_.expect("OPEN PROG 1000 CLEAR X1 CLOSE", "");
    b_.expect("PASSWORD=Open sesame", "");
    b_.expect("SAVE", "");
    b_.machine.power_cycle();
    if (!connected("password")) return;
    b_.expect("LIST PROG 1000", "ERR002");
    b_.expect("OPEN PLC 15", "ERR002");
    b_.expect("PASSWORD=open sesame", "ERR002");
    b_.expect("PASSWORD=Open sesame", "");
    b_.expect("LIST PROG 1000", "X1|RET");
    const std::string p10 = b_.ask("P10");
    b_.link.command("$$$***");
    b_.expect("I17 P10", "10|" + p10);
    b_.report.equal<std::string>("problems in ???", b_.problems(), "none");
  }

  BenchContext& b_;
  std::mt19937_64 random_;
  Content stored_;
  Tick duration_ = 0;
  unsigned compared_ = 0;
};

}  // namespace

Bench save_restore_bench() {
  return {"save-restore",
          "random content, SAVE, and starts by $$$, reset line, INIT/ and power behind a SAVE and inside it",
          {"two values are not what the scoreboard is told", "reset line: what was SAVEd",
           "P10 P8191: *, expected nobody's|values"},
          [](BenchContext& b) { SaveRestore(b).run(); }};
}

}  // namespace brick
