// Where an answer of the controller ends and what of it are checksums, and where a fetch of it stops (ethernet:4).
// Answers from firmware:6.2, firmware:6.3, firmware:6.5.
#include <gtest/gtest.h>

#include "testbench/host/controller_answer.h"
#include "testbench/host/output_queue.h"
#include "testbench/host/reply_parser.h"
#include "testbench/unit/firmware_platform/framing.h"

namespace brick {
namespace {

using Bytes = std::string;

struct Heard {
  Bytes text;
  bool ended_by_itself = false, sums = false;
};

Heard heard(const Bytes& bytes, const Bytes& command, bool expects_sums) {
  ControllerAnswer answer(command_checksum(command), expects_sums);
  Heard found;
  for (const char c : bytes) {
    EXPECT_FALSE(answer.ended()) << "too early in " << bytes;
    answer.take(static_cast<std::uint8_t>(c));
    found.text += answer.release();
  }
  found.ended_by_itself = answer.ended();
  if (!found.ended_by_itself) answer.quiet();
  EXPECT_TRUE(answer.ended());
  found.text += answer.release();
  found.sums = answer.had_sums();
  return found;
}

// The same text whatever I4 is (ethernet:4/3), whether or not there were checksums before.
TEST(ControllerAnswer, ChecksumsAreTakenOutInEveryFraming) {
  for_each_framing([](Framing framing, const Bytes&, const Bytes& command, const std::vector<Bytes>& data) {
    const bool sums = framing.i4 % 2 == 1;
    const Bytes bytes = framed(framing, command, data);
    if (bytes.empty()) return;
    for (const bool before : {false, true}) {
      if (sums && !before && data.empty()) continue;  // nothing tells: see the next but one
      const Heard found = heard(bytes, command, before);
      EXPECT_EQ(found.text, framed({framing.i3, 0}, command, data)) << "I3=" << framing.i3 << " I4=" << framing.i4;
      EXPECT_EQ(found.sums, sums);
    }
  });
}

TEST(ControllerAnswer, EndsWithItsAcknowledgeWithoutAWait) {
  EXPECT_TRUE(heard("\x06", "J/", false).ended_by_itself);
  EXPECT_TRUE(heard("25\r50\r\x06", "P1..2", false).ended_by_itself);
  EXPECT_TRUE(heard("\x07"
                    "ERR003\r",
                    "UUU", false)
                  .ended_by_itself);
  EXPECT_TRUE(heard("12\r\x07"
                    "ERR003\r",
                    "P1UUU", false)
                  .ended_by_itself);
  EXPECT_TRUE(heard("\x07\rERR003\r", "UUU", false).ended_by_itself) << "I6=3";
  EXPECT_TRUE(heard("\x07\nERR003\r", "UUU", false).ended_by_itself) << "I3=1";
  EXPECT_FALSE(heard("\x07", "UUU", false).ended_by_itself) << "I6=0";
  EXPECT_FALSE(heard("\n", "J/", false).ended_by_itself) << "I3=1: data may follow";
}

// "A" and CR sum up to "N": two may be text, three are no chance.
TEST(ControllerAnswer, ThreeRightChecksumsAreBelieved) {
  ControllerAnswer answer(command_checksum("P1..3"), false);
  ASSERT_EQ(checksum("A\r"), 'N');
  for (const char* expected : {"", "", "A\rA\rA\r"}) {
    for (const char c : Bytes("A\rN")) answer.take(static_cast<std::uint8_t>(c));
    EXPECT_EQ(answer.release(), expected);
  }
}

// One is: with the first wrong one it is known that it was, also where nothing but silence ends the answer.
TEST(ControllerAnswer, AWrongChecksumMakesARightOneText) {
  for (const bool before : {false, true}) {
    const Heard found = heard("A\rN\rX", "P1..3", before);
    EXPECT_EQ(found.text, "A\rN\rX");
    EXPECT_FALSE(found.sums || found.ended_by_itself);
  }
}

// A value whose characters and CR sum up to ACK: 0x06 behind its CR is a checksum or the end.
TEST(ControllerAnswer, AChecksumThatLooksLikeAnAcknowledge) {
  const Bytes value = "ZZ6";  // 5A + 5A + 36 + 0D = F7; + 0F
  Bytes line = value;
  line.push_back('\x0F');
  line += '\r';
  ASSERT_EQ(checksum(line), '\x06');
  EXPECT_EQ(heard(line + "\x06", "P1", false).text, line + "\x06");
  EXPECT_EQ(heard(line + "\x06\x06" + checksum("P1"), "P1", false).text, line + "\x06");
}

// firmware:6.7: what a program sends has a checksum as any line, its errors with their tag have none.
TEST(ControllerAnswer, ErrorsOfProgramsBetweenLinesHaveNoChecksum) {
  const Bytes error =
                  "\x02"
                  "ERR003\r",
              text = "\x02Hello\r", line = "25\r";
  const Heard found =
      heard(error + line + checksum(line) + text + checksum(text) + "\x06" + checksum("P1"), "P1", true);
  EXPECT_EQ(found.text, error + line + text + "\x06");
  EXPECT_TRUE(found.sums && found.ended_by_itself);
}

// A checksum that comes when nobody waits for it is the dialogue's: here the end is the acknowledge.
TEST(ControllerAnswer, AnAcknowledgeAloneIsTheEndUnlessThereWereChecksums) {
  ControllerAnswer answer(command_checksum("J/"), false), next(command_checksum("J/"), true);
  answer.take(0x06);
  EXPECT_TRUE(answer.ended());
  next.take(0x06);
  EXPECT_FALSE(next.ended());
  EXPECT_TRUE(next.may_have_ended());
  next.quiet();
  EXPECT_EQ(next.release(), "\x06");
  EXPECT_FALSE(next.had_sums());
}

// One checksum in 256 is right by chance; after three the text goes on at once.
TEST(ControllerAnswer, LongAnswersAreNotHeldBack) {
  ControllerAnswer plain, summed(0, true);
  Bytes text;
  const Bytes line = "12345\r";
  for (int i = 0; i < 4; ++i)
    for (const char c : line) {
      plain.take(static_cast<std::uint8_t>(c));
      summed.take(static_cast<std::uint8_t>(c));
      if (c == '\r') summed.take(static_cast<std::uint8_t>(checksum(line)));
    }
  EXPECT_EQ(plain.release(), line + line + line + line);
  EXPECT_EQ(summed.release(), line + line + line + line);
}

TEST(ControllerAnswer, ErrorNumber) {
  ControllerAnswer answer;
  for (const char c : Bytes("5\r\x07"
                            "ERR012\r"))
    answer.take(static_cast<std::uint8_t>(c));
  EXPECT_TRUE(answer.error());
  EXPECT_EQ(answer.error_number(), 12u);
}

// --------------------------------------------------------------------------------------------------------------- queue

TEST(OutputQueue, AFetchStopsAtTheEndOfAnAnswer) {
  OutputQueue queue;
  queue.add(
      "25\r50\r\x06"
      "7\r\n");
  EXPECT_EQ(queue.take_answer(1400), "25\r50\r\x06");
  EXPECT_EQ(queue.take_answer(1400), "7\r\n");
  queue.add(
      "12\r\x07"
      "ERR003\r"
      "5\r");
  EXPECT_EQ(queue.take_answer(1400),
            "12\r\x07"
            "ERR003\r")
      << "the CR behind BEL";
  EXPECT_EQ(queue.take_answer(1400), std::nullopt);
  queue.add("\x02HELLO\r\x06");
  EXPECT_EQ(queue.take_answer(1400), "5\r\x02HELLO\r") << "the CR behind STX";
  EXPECT_EQ(queue.take_line(1400), "\x06");
  EXPECT_TRUE(queue.empty());
}

TEST(OutputQueue, LongAnswersInPiecesOfOneSize) {
  OutputQueue queue;
  queue.add(Bytes(1399, 'x'));
  EXPECT_EQ(queue.take_answer(1400), std::nullopt) << "never a shorter piece";
  queue.add(Bytes(1402, 'x') + "\x06");
  EXPECT_EQ(queue.take_answer(1400), Bytes(1400, 'x'));
  EXPECT_EQ(queue.take_answer(1400), Bytes(1400, 'x'));
  EXPECT_EQ(queue.take_answer(1400), "x\x06");
  queue.add("\x07" + Bytes(1400, 'x') + "\r\x06");
  EXPECT_EQ(queue.take_answer(1400)->size(), 1400u);
  EXPECT_EQ(queue.take_answer(1400), "x\r") << "BEL was in the piece before";
  EXPECT_EQ(queue.take_line(1400), "\x06");
  queue.add("\x07" + Bytes(1399, 'x'));
  EXPECT_EQ(queue.take_answer(1400)->size(), 1400u);
  queue.add("x\r\x06");
  EXPECT_EQ(queue.take_answer(1400), "x\r") << "also of a piece that was all there was";
}

TEST(OutputQueue, LinesEndAtReturnAcknowledgeOrLineFeed) {
  OutputQueue queue;
  queue.add("25\r50\n\x06x");
  EXPECT_EQ(queue.take_line(1400), "25\r");
  EXPECT_EQ(queue.take_line(1400), "50\n");
  EXPECT_EQ(queue.take_line(1400), "\x06");
  EXPECT_EQ(queue.take_line(1400), std::nullopt);
  EXPECT_EQ(queue.take(1400), "x");
  queue.add("12345\r6");
  EXPECT_EQ(queue.take_line(4), "1234") << "no more than is asked for";
  EXPECT_EQ(queue.take_line(4), "5\r");
  queue.add("789");
  EXPECT_EQ(queue.take_line(5), std::nullopt) << "6789 goes on";
  EXPECT_EQ(queue.take_line(4), "6789") << "as much as is asked for";
}

TEST(OutputQueue, HasALimit) {
  OutputQueue queue;
  for (int i = 0; i < 3000; ++i) queue.add(Bytes(1000, 'x'));
  EXPECT_EQ(queue.size(), OutputQueue::kLimit);
}

}  // namespace
}  // namespace brick
