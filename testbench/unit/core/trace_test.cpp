// Waveform files: order of records that come from sources that run ahead of each other, window, both formats.
#include "systemc/core/trace.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>

#include "testbench/unit/covers.h"

namespace brick {
namespace {

constexpr TimeFs kPs = 1000;

std::string read(const std::string& file) {
  std::ifstream in(file);
  std::stringstream s;
  s << in.rdbuf();
  return s.str();
}

std::string body(const std::string& vcd) {
  const std::string mark = "$enddefinitions $end\n";
  const auto at = vcd.find(mark);
  return at == std::string::npos ? "" : vcd.substr(at + mark.size());
}

class Trace : public ::testing::Test {
 protected:
  // One file a process: ctest runs the tests side by side.
  std::string path(const std::string& ending) const {
    return ::testing::TempDir() + "brick_trace_" + ::testing::UnitTest::GetInstance()->current_test_info()->name() +
           ending;
  }
  // Two signals and a text, as every test below uses them.
  Signals signals;
  Signals::Id rd_n = signals.add("bus.rd_n", 1, Radix::kBinary, 1);
  Signals::Id addr = signals.add("bus.addr", 4, Radix::kHex, 0);
  Signals::Id symbol = signals.add("cpu.symbol", 1, Radix::kText);

  std::string vcd(TimeFs from, TimeFs to, const std::function<void(TraceWriter&)>& run) {
    const std::string file = path(".vcd");
    {
      auto writer = TraceWriter::open(file, from, to);
      signals.attach(writer.get());
      run(*writer);
      writer->close();
      signals.attach(nullptr);
    }
    std::string text = read(file);
    std::remove(file.c_str());
    return text;
  }
};

// Femtoseconds beyond 64 bits; what a viewer's picoseconds could not hold is left out, and the rest is whole.
TEST_F(Trace, GoesOnForMonths) {
  constexpr TimeFs kFs63 = TimeFs{1} << 63, kPs63 = kFs63 * 1000;
  const std::string text = vcd(0, kForever, [&](TraceWriter& w) {
    signals.set(addr, kFs63 - kPs, 1);
    signals.set(addr, kFs63, 2);
    signals.set(addr, 2 * kFs63, 3);
    signals.set(addr, kPs63 - kPs, 4);
    signals.set(addr, kPs63 + kPs, 5);
    signals.set(addr, 2 * kPs63 + kPs, 6);
    w.flush_until(2 * kPs63 + 2 * kPs);
  });
  const auto has = [&](const std::string& part) { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(has("#9223372036854774\nb0001")) << text;
  EXPECT_TRUE(has("#9223372036854775\nb0010")) << text;
  EXPECT_TRUE(has("#18446744073709551\nb0011")) << text;
  EXPECT_TRUE(has("#9223372036854775807\nb0100")) << text;
  EXPECT_FALSE(has("b0101")) << text;
  EXPECT_FALSE(has("b0110")) << text;
}

TEST_F(Trace, VcdHasTopScopeAndOneScopeADot) {
  BRICK_COVERS("CARD-4");
  const std::string text = vcd(0, kForever, [](TraceWriter&) {});
  EXPECT_THAT(text, ::testing::HasSubstr("$timescale 1 ps $end\n"));
  EXPECT_THAT(text, ::testing::HasSubstr("$scope module brick $end\n"
                                         "$scope module bus $end\n"
                                         "$var wire 4 \" addr [3:0] $end\n"
                                         "$var wire 1 ! rd_n $end\n"
                                         "$upscope $end\n"
                                         "$scope module cpu $end\n"
                                         "$var string 1 # symbol $end\n"
                                         "$upscope $end\n"
                                         "$upscope $end\n"));
  EXPECT_EQ(body(text), "#0\n$dumpvars\n1!\nb0000 \"\ns #\n$end\n");
}

TEST_F(Trace, RecordsOfSourcesThatRunAheadComeOutInOrder) {
  BRICK_COVERS("CARD-4");
  const std::string text = vcd(0, kForever, [&](TraceWriter& w) {
    signals.set(addr, 30 * kPs, 0xA);  // one source is ahead
    signals.set(rd_n, 20 * kPs, 0);
    w.flush_until(25 * kPs);
    signals.set(rd_n, 30 * kPs, 1);
    signals.set(addr, 40 * kPs, 0xB);
    signals.set_text(symbol, 35 * kPs, "a b\\");
    w.flush_until(50 * kPs);
  });
  EXPECT_EQ(
      body(text),
      "#0\n$dumpvars\n1!\nb0000 \"\ns #\n$end\n#20\n0!\n#30\nb1010 \"\n1!\n#35\nsa\\040b\\134 #\n#40\nb1011 \"\n#50\n");
}

TEST_F(Trace, ManyLotsStayInOrder) {
  const std::string text = vcd(0, kForever, [&](TraceWriter& w) {
    for (int i = 1; i <= 100'000; ++i) {
      signals.set(addr, (2 * i + 9) * kPs, static_cast<std::uint64_t>(i & 15));  // up to 9 ps ahead
      signals.set(rd_n, 2 * i * kPs, static_cast<std::uint64_t>(i & 1));
      w.flush_until(2 * i * kPs);
    }
  });
  std::istringstream in(body(text));
  long long last = -1;
  int times = 0;
  for (std::string line; std::getline(in, line);) {
    if (line[0] != '#') continue;
    const long long t = std::stoll(line.substr(1));
    ASSERT_GT(t, last);
    last = t;
    ++times;
  }
  EXPECT_EQ(last, 200'009);
  // time 0, rd_n at 4, 6, ... 200000 (it is 1 already at 2), addr at 11, 13, ... 200009
  EXPECT_EQ(times, 1 + 99'999 + 100'000);
}

TEST_F(Trace, WindowBeginsWithTheValuesThatStandThere) {
  BRICK_COVERS("CARD-4");
  const std::string text = vcd(100 * kPs, 200 * kPs, [&](TraceWriter& w) {
    signals.set(addr, 50 * kPs, 5);
    signals.set(rd_n, 100 * kPs, 0);  // at the very start: part of the dump
    signals.set(addr, 150 * kPs, 6);
    signals.set(rd_n, 200 * kPs, 1);  // at the very end: inside
    signals.set(addr, 201 * kPs, 7);
    w.flush_until(500 * kPs);
  });
  EXPECT_EQ(body(text), "#100\n$dumpvars\n0!\nb0101 \"\ns #\n$end\n#150\nb0110 \"\n#200\n1!\n");
}

TEST_F(Trace, FstHoldsTheSameAsVcd) {
  BRICK_COVERS("CARD-4");
  if (std::system("fst2vcd --help >/dev/null 2>&1") == 127 << 8) GTEST_SKIP() << "fst2vcd is not installed";
  const std::string file = path(".fst"), converted = path(".out");
  {
    auto writer = TraceWriter::open(file, 0, 60 * kPs);
    signals.attach(writer.get());
    signals.set(addr, 30 * kPs, 0xA);
    signals.set(rd_n, 20 * kPs, 0);
    signals.set_text(symbol, 40 * kPs, "main");
    signals.set(addr, 61 * kPs, 0xF);
    writer->flush_until(100 * kPs);
    writer->close();
    signals.attach(nullptr);
  }
  ASSERT_EQ(std::system(("fst2vcd -f " + file + " -o " + converted).c_str()), 0);
  const std::string text = read(converted);
  EXPECT_THAT(text, ::testing::HasSubstr("1ps"));
  EXPECT_THAT(text, ::testing::HasSubstr("$scope module brick $end\n$scope module bus $end\n"));
  EXPECT_THAT(text, ::testing::ContainsRegex("wire 4 . addr \\[3:0\\]"));
  EXPECT_THAT(text, ::testing::ContainsRegex("string [01] . symbol"));
  EXPECT_THAT(text, ::testing::ContainsRegex("#20\n0.\n#30\nb1010 .\n#40\nsmain .\n"));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("b1111")));
  std::remove(file.c_str());
  std::remove(converted.c_str());
}

TEST_F(Trace, NumbersWithAFractionAreRealVariables) {
  const Signals::Id position = signals.add("plant.axis1.position", 64, Radix::kReal, bits_of(-0.5));
  const auto run = [&](TraceWriter& w) {
    signals.set(position, 20 * kPs, bits_of(1.25));
    signals.set(position, 30 * kPs, bits_of(-3e-7));
    w.flush_until(40 * kPs);
  };
  const std::string text = vcd(0, 60 * kPs, run);
  EXPECT_THAT(text, ::testing::HasSubstr("$var real 64 $ position $end\n"));
  EXPECT_THAT(body(text), ::testing::HasSubstr("r-0.5 $\n"));
  EXPECT_THAT(body(text), ::testing::HasSubstr("#20\nr1.25 $\n#30\nr-3e-07 $\n"));

  if (std::system("fst2vcd --help >/dev/null 2>&1") == 127 << 8) GTEST_SKIP() << "fst2vcd is not installed";
  const std::string file = path(".fst"), converted = path(".out");
  {
    auto writer = TraceWriter::open(file, 0, 60 * kPs);
    signals.attach(writer.get());
    signals.set(position, 50 * kPs, bits_of(7.75));
    writer->flush_until(60 * kPs);
    writer->close();
    signals.attach(nullptr);
  }
  ASSERT_EQ(std::system(("fst2vcd -f " + file + " -o " + converted).c_str()), 0);
  const std::string fst = read(converted);
  EXPECT_THAT(fst, ::testing::ContainsRegex("real [0-9]+ . position"));
  EXPECT_THAT(fst, ::testing::ContainsRegex("r-0.0000003|r-3e-07"));
  EXPECT_THAT(fst, ::testing::ContainsRegex("#50\nr7.75 .\n"));
  std::remove(file.c_str());
  std::remove(converted.c_str());
}

// A file that takes no more than its header: as on a disk that is full, but for this process alone.
TEST_F(Trace, TellsThatThereWasNoRoom) {
  for (const std::string ending : {".fst", ".vcd"}) {
    const std::string file = path(ending);
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    auto writer = TraceWriter::open(file);
    signals.attach(writer.get());
    rlimit small = before;
    small.rlim_cur = 400;
    setrlimit(RLIMIT_FSIZE, &small);
    for (unsigned i = 1; i < 1000; ++i) signals.set(addr, i * kPs, i * 7 % 16);
    writer->flush_until(1000 * kPs);
    EXPECT_THROW(writer->close(), std::runtime_error) << ending;
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    signals.attach(nullptr);
    std::remove(file.c_str());
  }
}

// Where somebody is told, what is there ends with a whole line and its time, and whoever records may go on.
TEST_F(Trace, AFileThatTakesNoMoreEndsTheWaveformAlone) {
  const std::string file = path(".vcd");
  constexpr TimeFs kNs = 1000 * kPs;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  auto writer = TraceWriter::open(file);
  std::vector<std::string> told;
  writer->on_failure = [&](const std::string& why) { told.push_back(why); };
  signals.attach(writer.get());
  rlimit small = before;
  small.rlim_cur = 100'000;
  setrlimit(RLIMIT_FSIZE, &small);
  for (unsigned i = 1; i < 100'000; ++i) {
    signals.set(addr, i * kNs, i % 16);
    writer->flush_until(i * kNs);
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  signals.attach(nullptr);
  const std::string text = read(file);
  const std::size_t last = text.rfind('#');
  ASSERT_NE(last, std::string::npos);
  EXPECT_EQ(text.back(), '\n');
  const std::string time = fmt::format("{:.6f} ms", (std::stod(text.substr(last + 1)) - 1000) * 1e-9);
  EXPECT_EQ(told, std::vector<std::string>{file + ": cannot write the waveform beyond " + time + ": File too large"});
  EXPECT_THROW(writer->close(), std::runtime_error);
  std::remove(file.c_str());
}

// Nobody closes it, as behind an error: what cannot be written then is said, and nothing is thrown.
TEST_F(Trace, AWriterThatIsLeftSaysThatThereWasNoRoom) {
  for (const std::string ending : {".fst", ".vcd"}) {
    const std::string file = path(ending);
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    auto writer = TraceWriter::open(file);
    signals.attach(writer.get());
    for (unsigned i = 1; i < 1000; ++i) signals.set(addr, i * kPs, i * 7 % 16);
    signals.attach(nullptr);
    ::testing::internal::CaptureStderr();
    rlimit small = before;
    small.rlim_cur = 400;
    setrlimit(RLIMIT_FSIZE, &small);
    writer.reset();
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_THAT(::testing::internal::GetCapturedStderr(), ::testing::StartsWith(file + ": cannot write the waveform"));
    std::signal(SIGXFSZ, handler);
    std::remove(file.c_str());
  }
}

TEST(TraceOpen, SaysWhatIsWrongWithTheFileName) {
  EXPECT_THROW(
      {
        try {
          TraceWriter::open("wave.txt");
        } catch (const std::runtime_error& e) {
          EXPECT_STREQ(e.what(), "wave.txt: waveform files end in .vcd or .fst");
          throw;
        }
      },
      std::runtime_error);
  EXPECT_THROW(TraceWriter::open("/nonexistent/folder/wave.vcd"), std::runtime_error);
  EXPECT_THROW(TraceWriter::open("/nonexistent/folder/wave.fst"), std::runtime_error);
  EXPECT_THROW(TraceWriter::open("wave.vcd", 10, 5), std::runtime_error);
}

}  // namespace
}  // namespace brick
