// Breakpoints, steps, watchpoints, the break byte, and how a session ends.
#include "testbench/unit/gdb/gdb_bench.h"

namespace brick {

using GdbRunControl = GdbBench;

TEST_F(GdbRunControl, StepsOneInstruction) {
  EXPECT_EQ(ask("s"), "T05thread:1;");
  EXPECT_EQ(ask("p20"), shown(kCode + 4));
  EXPECT_EQ(ask("vCont;s:1;c"), "T05thread:1;");
  EXPECT_EQ(ask("p20"), shown(kCode + 8));
  EXPECT_EQ(cpu.instructions(), 2u);
  EXPECT_EQ(ask("s1000000c"), "T05thread:1;") << "from another address: the load at +12";
  EXPECT_EQ(ask("p20"), shown(kCode + 16));
}

TEST_F(GdbRunControl, StopsAtABreakpointEachTimeRound) {
  ASSERT_EQ(ask("Z0,10000008,4"), "OK");
  for (std::uint32_t round = 1; round <= 3; ++round) {
    EXPECT_EQ(ask("c"), "T05swbreak:;thread:1;");
    EXPECT_EQ(ask("p20"), shown(kCode + 8));
    EXPECT_EQ(ask("pa"), shown(round));
  }
  EXPECT_EQ(ask("z0,10000008,4"), "OK");
  EXPECT_EQ(ask("Z1,10000010,4"), "OK");
  EXPECT_EQ(ask("c"), "T05hwbreak:;thread:1;");
  EXPECT_EQ(ask("p20"), shown(kCode + 16));
  EXPECT_EQ(ask("m10000008,4").substr(0, 2), "23") << "breakpoints are not written into the code";
}

TEST_F(GdbRunControl, BreakpointsCostNoTime) {
  // Three rounds: lui 1, then addi 1 + sw 1 + lw 2 + jal 2 each; stopped before the fourth addi.
  ASSERT_EQ(ask("Z0,10000004,4"), "OK");
  for (int i = 0; i < 4; ++i) ASSERT_EQ(ask("c"), "T05swbreak:;thread:1;");
  EXPECT_EQ(cpu.cycle(), 1 + 3 * 6);
}

TEST_F(GdbRunControl, StopsAfterAWatchedStore) {
  ASSERT_EQ(ask("Z2,2000000a,1"), "OK") << "one byte within the stored word";
  EXPECT_EQ(ask("c"), "T05watch:2000000a;thread:1;");
  EXPECT_EQ(ask("p20"), shown(kCode + 12));
  EXPECT_EQ(ask("m20000008,4"), shown(1));
  ASSERT_EQ(ask("z2,2000000a,1"), "OK");
  ASSERT_EQ(ask("Z2,20000004,4"), "OK") << "only loaded, never stored";
  ASSERT_EQ(ask("Z0,10000010,4"), "OK");
  EXPECT_EQ(ask("c"), "T05swbreak:;thread:1;");
}

TEST_F(GdbRunControl, StopsAfterAWatchedLoad) {
  ASSERT_EQ(ask("Z3,20000004,4"), "OK");
  ASSERT_EQ(ask("Z3,20000008,4"), "OK") << "only stored, never loaded";
  EXPECT_EQ(ask("c"), "T05rwatch:20000004;thread:1;");
  EXPECT_EQ(ask("p20"), shown(kCode + 16));
  ASSERT_EQ(ask("Z4,20000008,4"), "OK");
  EXPECT_EQ(ask("c"), "T05awatch:20000008;thread:1;");
}

TEST_F(GdbRunControl, BreakByteStopsTheProgram) {
  write(framed("c"));
  EXPECT_EQ(get(), '+');
  EXPECT_TRUE(runs_beyond(1000));
  write("\x03");
  EXPECT_EQ(reply(), "T02thread:1;");
  const auto count = cpu.instructions();  // the runner serves the debugger now
  EXPECT_EQ(ask("?"), "T02thread:1;");
  EXPECT_EQ(ask("pa"), ask("pa"));
  EXPECT_EQ(cpu.instructions(), count) << "a stopped program stands";
}

TEST_F(GdbRunControl, BreakByteStopsSteppedRunningToo) {
  ASSERT_EQ(ask("Z0,10000800,4"), "OK") << "never reached, but checked before each instruction";
  write(framed("c") + "\x03");
  EXPECT_EQ(reply(), "T02thread:1;");
}

TEST_F(GdbRunControl, StepGoesThroughAnInterruptHandler) {
  // Handler at +0x100: counts in t1, masks the interrupt, returns.
  using namespace rv;
  const std::vector<Word> handler = {addi(t1, t1, 1), rv::i(0x73, 1, zero, zero, 0x304), 0x30200073u};
  std::memcpy(cpu.memory(kCode + 0x100, 12), handler.data(), 12);
  const std::vector<Word> enable = {rv::i(0x73, 1, zero, a3, 0x305), rv::i(0x73, 1, zero, a4, 0x304),
                                    rv::i(0x73, 6, zero, 8, 0x300), addi(a5, a5, 5), addi(a5, a5, 5)};
  std::memcpy(cpu.memory(kCode + 0x40, 20), enable.data(), 20);
  cpu.invalidate_code();
  ASSERT_EQ(ask("Pd=" + shown(kCode + 0x100)), "OK");
  ASSERT_EQ(ask("Pe=" + shown(1u << kIrqRealTime)), "OK");
  ASSERT_EQ(ask("P20=" + shown(kCode + 0x40)), "OK");
  cpu.set_interrupt(kIrqRealTime, true);  // the runner stands while the debugger is served
  for (int i = 0; i < 3; ++i) ASSERT_EQ(ask("s"), "T05thread:1;");
  ASSERT_EQ(ask("p20"), shown(kCode + 0x4C)) << "interrupts are on, and one is pending";
  EXPECT_EQ(ask("p6"), shown(0));
  EXPECT_EQ(ask("s"), "T05thread:1;");
  EXPECT_EQ(ask("p20"), shown(kCode + 0x50));
  EXPECT_EQ(ask("p6"), shown(1)) << "the handler has run";
  EXPECT_EQ(ask("pf"), shown(5)) << "and so has the instruction";
}

// With GDB's numbers: 4 illegal instruction, 5 trap, 10 bus error, 11 segmentation fault, 12 bad system call. Stopped
// before the handler, at +0x100, continued or stepped; what the machine says of it comes first.
TEST_F(GdbRunControl, StopsAtAnExceptionOfTheProgram) {
  using namespace rv;
  cpu.on_trap = [this](std::uint32_t cause, std::uint32_t, Cycle) { server->exception(cause, "why"); };
  const std::vector<std::pair<Word, const char*>> faults = {
      {0xFFFF'FFFF, "T04thread:1;"},   {ebreak(), "T05thread:1;"},
      {lw(a2, a5, 1), "T0athread:1;"}, {rv::s(2, a0, a5, 1), "T0athread:1;"},
      {lw(a2, a5, 0), "T0bthread:1;"}, {rv::s(2, a0, a5, 0), "T0bthread:1;"},
      {ecall(), "T0cthread:1;"}};
  const Word to_handler = rv::i(0x73, 1, zero, a3, 0x305);
  for (const char* how : {"c", "s"})
    for (const auto& [word, stop] : faults) {
      std::memcpy(cpu.memory(kCode + 0x40, 4), &to_handler, 4);
      std::memcpy(cpu.memory(kCode + 0x44, 4), &word, 4);
      cpu.invalidate_code();
      ASSERT_EQ(ask("Pd=" + shown(kCode + 0x100)), "OK");
      ASSERT_EQ(ask("Pf=" + shown(0x5000'0000)), "OK");
      ASSERT_EQ(ask("P20=" + shown(kCode + 0x40)), "OK");
      ASSERT_EQ(ask("s"), "T05thread:1;");
      EXPECT_EQ(ask(how), "O7768790a") << "on the console";
      EXPECT_EQ(reply(), stop);
      EXPECT_EQ(ask("p20"), shown(kCode + 0x100));
      EXPECT_EQ(ask("p382"), shown(kCode + 0x44)) << "mepc";
    }
}

TEST_F(GdbRunControl, DetachLetsTheProgramRunOn) {
  ASSERT_EQ(ask("Z0,10000008,4"), "OK");
  EXPECT_EQ(ask("D"), "OK");
  EXPECT_EQ(get(), '\0') << "the connection is closed";
  EXPECT_TRUE(runs_beyond(1000));
}

TEST_F(GdbRunControl, LostConnectionIsADetach) {
  ASSERT_EQ(ask("Z0,10000008,4"), "OK");
  socket.close();
  EXPECT_TRUE(runs_beyond(1000));
}

TEST_F(GdbRunControl, AnotherDebuggerStopsTheProgramAgain) {
  ASSERT_EQ(ask("D"), "OK");
  socket.close();
  socket.connect({asio::ip::address_v4::loopback(), server->port()});
  EXPECT_EQ(ask("?"), "T05thread:1;");
}

TEST_F(GdbRunControl, KillEndsTheRun) {
  write(framed("k"));
  runner.join();
  EXPECT_TRUE(killed);
}

TEST_F(GdbRunControl, EndOfTheRunIsTold) {
  write(framed("c"));
  ASSERT_EQ(get(), '+');
  done = true;
  runner.join();
  server.reset();
  EXPECT_EQ(reply(), "W00");
}

}  // namespace brick
