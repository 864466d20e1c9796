// Background variable buffers (host-bus:6.7): lists of words that are shown to the host, or written by it.
#include <random>

#include "testbench/unit/firmware_program/dpram_host.h"
#include "testbench/unit/random_seed.h"

namespace {

using platform::background;
using platform::host;

// Type word of an entry, host-bus:6.7.
enum Space : unsigned { kY, kLong, kX, kDpram };
constexpr unsigned kRead = 0x100, kWrite = 0x400;  // starts, PMAC addresses from $060450 on

class DpramVariables : public FirmwareTest {
 protected:
  void SetUp() override {
    FirmwareTest::SetUp();
    ASSERT_EQ(host("I3=2 I6=1 I55=1"), "");
  }
  static std::uint32_t place(unsigned start, unsigned item) { return DPRAM_OPEN + 4 * (start + item); }
  void entry(std::uint32_t offset, unsigned address, Space space, unsigned width = 0, unsigned lsb = 0) {
    ram.write(offset, static_cast<std::uint16_t>(address));
    ram.write(offset + 2, static_cast<std::uint16_t>(space | width << 2 | lsb << 7 | (address >> 16) << 12));
  }
  void write_entry(unsigned number, unsigned address, Space space, std::uint32_t low, std::uint32_t high = 0,
                   unsigned width = 0, unsigned lsb = 0) {
    const std::uint32_t at = place(kWrite, 3 * number);
    entry(at, address, space, width, lsb);
    dpram_write_item(at + 4, low);
    dpram_write_item(at + 8, high);
  }
  void begin(unsigned size, unsigned control = 0) {
    ram.write(DPRAM_READ_CONTROL, static_cast<std::uint16_t>(control));
    ram.write(DPRAM_READ_START, kRead);
    ram.write(DPRAM_READ_SIZE, static_cast<std::uint16_t>(size));
  }
  void write(unsigned size) {
    ram.write(DPRAM_WRITE_START, kWrite);
    ram.write(DPRAM_WRITE_SIZE, static_cast<std::uint16_t>(size));
    background(1);
  }
  std::uint32_t data(unsigned size, unsigned item) { return dpram_read_item(place(kRead, size + item)); }
  bool ready() { return (ram.read(DPRAM_READ_CONTROL) & DPRAM_READ_READY) != 0; }

  platform::NativeDpram ram;
};

TEST_F(DpramVariables, EachSpaceWidthAndPlaceIsShown) {
  ASSERT_EQ(host("WX$20,$FEDCBA WY$20,$123456 WY$60480,$4321 WX$60480,$8765"), "");
  entry(place(kRead, 0), 0x20, kY);
  entry(place(kRead, 1), 0x20, kX);
  entry(place(kRead, 2), 0x20, kLong);
  entry(place(kRead, 3), 0x20, kX, 8, 4);
  entry(place(kRead, 4), 0x20, kX, 1, 23);
  entry(place(kRead, 5), 0x60480, kDpram);
  entry(place(kRead, 6), 0x20, kY, 24, 8);
  begin(7);
  background(1);
  ASSERT_TRUE(ready());
  const std::uint32_t expected[] = {0x123456, 0xFFFEDCBA, 0x123456, 0xFFFEDCBA, 0xCB, 1, 0x87654321, 0x1234};
  for (unsigned i = 0; i < 8; ++i) EXPECT_EQ(data(7, i), expected[i]) << i;
}

// Data stay until the host has cleared bit 0.
TEST_F(DpramVariables, SingleUser) {
  entry(place(kRead, 0), 0x20, kY);
  begin(1);
  ASSERT_EQ(host("WY$20,1"), "");
  background(1);
  ASSERT_TRUE(ready());
  EXPECT_EQ(ram.read(DPRAM_READ_TIMER), std::stoul(host("RX$0")) & 0xFFFF);
  ASSERT_EQ(host("WY$20,2"), "");
  background(3);
  EXPECT_EQ(data(1, 0), 1U);
  ram.write(DPRAM_READ_CONTROL, 0);
  background(1);
  EXPECT_TRUE(ready());
  EXPECT_EQ(data(1, 0), 2U);
}

TEST_F(DpramVariables, SeveralUsersReleaseEntriesOneByOne) {
  entry(place(kRead, 0), 0x20, kY);
  entry(place(kRead, 1), 0x21, kY);
  begin(2, DPRAM_READ_MULTI_USER);
  ASSERT_EQ(host("WY$20,1 WY$21,1"), "");
  background(1);
  for (unsigned i = 0; i < 2; ++i) EXPECT_EQ(ram.read(place(kRead, i) + 2) & DPRAM_ENTRY_READY, DPRAM_ENTRY_READY) << i;
  ASSERT_EQ(host("WY$20,2 WY$21,2"), "");
  ram.write(place(kRead, 1) + 2, ram.read(place(kRead, 1) + 2) & 0x7FFF);
  background(2);
  EXPECT_EQ(data(2, 0), 1U);
  EXPECT_EQ(data(2, 1), 2U);
  EXPECT_EQ(ram.read(DPRAM_READ_CONTROL), DPRAM_READ_MULTI_USER);
  platform::servo_ticks(100);
  background(1);
  EXPECT_EQ(ram.read(DPRAM_READ_TIMER), std::stoul(host("RX$0")) & 0xFFFF);
}

// 128 entries take several passes; nothing is ready before the last.
TEST_F(DpramVariables, ALongListIsReadyWhenItIsWhole) {
  for (unsigned i = 0; i < 128; ++i) entry(place(kRead, i), 0xA000 + i, kY);
  for (unsigned i = 0; i < 128; ++i) ASSERT_EQ(host("WY" + std::to_string(0xA000 + i) + "," + std::to_string(i)), "");
  begin(128);
  background(1);
  EXPECT_FALSE(ready());
  background(10);
  ASSERT_TRUE(ready());
  for (unsigned i = 0; i < 128; ++i) EXPECT_EQ(data(128, i), i);
}

TEST_F(DpramVariables, EntriesAreWrittenAndTheSizeIsCleared) {
  ASSERT_EQ(host("WX$20,$FFFFFF WY$20,$FFFFFF WX$21,0 WY$21,0 WY$24,5"), "");
  write_entry(0, 0x20, kX, 0x123456);
  write_entry(1, 0x20, kY, 0x5, 0, 4, 8);
  write_entry(2, 0x21, kLong, 0x00ABCDEF, 0xFFFEDCBA);
  write_entry(3, 0x60480, kDpram, 0x87654321);
  write_entry(4, 0, kY, 7);
  write_entry(5, 0x24, kY, 6);
  write(6);
  EXPECT_EQ(ram.read(DPRAM_WRITE_SIZE), 0);
  EXPECT_EQ(host("RHX$20 RHY$20"), "123456|FFF5FF");
  EXPECT_EQ(host("RHX$21 RHY$21"), "FEDCBA|ABCDEF");
  EXPECT_EQ(dpram_read_item(4 * 0x480), 0x87654321U);
  EXPECT_EQ(host("RY$24"), "5") << "an address of 0 ends the list";
}

TEST_F(DpramVariables, ThirtyTwoEntriesAreWrittenInOnePass) {
  for (const unsigned size : {32U, 33U}) {
    for (unsigned i = 0; i < 33; ++i) ASSERT_EQ(host("WY" + std::to_string(0xA000 + i) + ",5"), "");
    for (unsigned i = 0; i < size; ++i) write_entry(i, 0xA000 + i, kY, i);
    write(size);
    EXPECT_EQ(ram.read(DPRAM_WRITE_SIZE), 0);
    for (unsigned i = 0; i < size; ++i)
      EXPECT_EQ(host("RY" + std::to_string(0xA000 + i)), std::to_string(size == 32 ? i : 5)) << size << " entry " << i;
  }
}

TEST_F(DpramVariables, VariablesAreReachedWhereTheyStand) {
  write_entry(0, 0x6005, kLong, 0x000801, 0x400000);  // 0.5 x 2^2, firmware:1.6
  write(1);
  EXPECT_EQ(host("P5"), "2");
}

TEST_F(DpramVariables, OffWithI55OrWithoutASize) {
  entry(place(kRead, 0), 0x20, kY);
  ASSERT_EQ(host("I55=0"), "");
  begin(1);
  write_entry(0, 0x20, kY, 9);
  write(1);
  EXPECT_FALSE(ready());
  EXPECT_EQ(ram.read(DPRAM_WRITE_SIZE), 1);
  ASSERT_EQ(host("I55=1"), "");
  for (const unsigned size : {0U, 129U, 0xFFFFU}) {
    begin(size);
    background(2);
    EXPECT_FALSE(ready()) << size;
  }
  write(33);
  EXPECT_EQ(ram.read(DPRAM_WRITE_SIZE), 0);
  EXPECT_EQ(host("RY$20"), "9") << "of I55 = 1 with the size 1 that waited, not of 33";
}

// The RAM keeps its content over a reset, and holds anything after power-on.
TEST_F(DpramVariables, NothingIsWrittenByAStart) {
  ASSERT_EQ(host("SAVE WY$A000,5"), "");
  write_entry(0, 0x6001, kLong, 0x000801, 0x400000);
  ram.write(DPRAM_WRITE_START, kWrite);
  ram.write(DPRAM_WRITE_SIZE, 1);
  platform::reset("$$$");
  background(2);
  EXPECT_EQ(host("I55 P1"), "1|0");
  EXPECT_EQ(ram.read(DPRAM_WRITE_SIZE), 0);
  platform::reset("$$$***");
  ram.write(DPRAM_WRITE_SIZE, 7);
  platform::reset("$$$***");
  EXPECT_EQ(ram.read(DPRAM_WRITE_SIZE), 7) << "with I55 = 0 the word is the user's";
}

TEST_F(DpramVariables, ItemsOfTheRamAreNowhereElse) {
  ASSERT_EQ(host("WX$20,$ABCDEF WY$20,$ABCDEF"), "");
  write_entry(0, 0x20, kDpram, 0x12345678);
  write_entry(1, 0x60500, kDpram, 0x12345678);
  write(2);
  background(1);
  EXPECT_EQ(host("RHX$20"), "ABCDEF");
  EXPECT_EQ(host("RHY$20"), "ABCDEF");
  EXPECT_EQ(dpram_read_item(4 * 0x500), 0x12345678U);
  entry(place(kRead, 0), 0x20, kDpram);
  entry(place(kRead, 1), 0x60500, kDpram);
  begin(2);
  background(1);
  ASSERT_TRUE(ready());
  EXPECT_EQ(data(2, 0), 0U);
  EXPECT_EQ(data(2, 1), 0x12345678U);
  ASSERT_EQ(host("WY$78002,$123 WX$78002,$456"), "");  // of a servo IC, behind the RAM
  write_entry(0, 0x78002, kDpram, 0x12345678);
  write(1);
  EXPECT_EQ(host("RHY$78002"), "123");
  entry(place(kRead, 0), 0x78002, kDpram);
  begin(1);
  background(1);
  EXPECT_EQ(data(1, 0), 0U);
}

// host-bus:6.1/3: the first item of the RAM and the last, and what stands beside them.
TEST_F(DpramVariables, ItemsAreInTheRamFromItsFirstToItsLast) {
  const struct {
    unsigned address;
    bool is_in;
  } items[] = {{0x5FFFF, false}, {0x60000, true}, {0x63FFF, true}, {0x64000, false}, {0x70010, false}};
  for (const auto& item : items) {
    const std::string address = std::to_string(item.address);
    ASSERT_EQ(host("WY" + address + ",$12 WX" + address + ",$34"), "");
    const std::string before = host("RHY" + address + " RHX" + address);
    dpram_write_item(place(kRead, 1), 0x5555);
    entry(place(kRead, 0), item.address, kDpram);
    begin(1);
    background(1);
    ASSERT_TRUE(ready());
    EXPECT_EQ(data(1, 0), item.is_in ? 0x340012U : 0U) << std::hex << item.address;
    write_entry(0, item.address, kDpram, 0x00560078);
    write(1);
    EXPECT_EQ(host("RHY" + address + " RHX" + address), item.is_in ? "78|56" : before) << std::hex << item.address;
  }
}

// What was read before I55 went off is not of the set that is ready after it.
TEST_F(DpramVariables, ASetThatWasLeftBeginsAnew) {
  for (unsigned i = 0; i < 20; ++i) entry(place(kRead, i), 0xA000, kY);
  ASSERT_EQ(host("WY$A000,1"), "");
  begin(20);
  background(1);
  ASSERT_FALSE(ready());
  ASSERT_EQ(host("I55=0"), "");
  background(1);
  ASSERT_FALSE(ready()) << "nothing goes on while it is off";
  ASSERT_EQ(host("WY$A000,2"), "");
  ASSERT_EQ(host("I55=1"), "");
  background(3);
  ASSERT_TRUE(ready());
  for (unsigned i = 0; i < 20; ++i) EXPECT_EQ(data(20, i), 2U) << i;
}

// The last list and the last data that the RAM holds, and the first that it does not.
TEST_F(DpramVariables, ListsEndWithTheRam) {
  const auto show_at = [this](unsigned start) {
    ram.write(DPRAM_READ_CONTROL, 0);
    ram.write(DPRAM_READ_SIZE, 0);
    background(1);
    if (4 * start + DPRAM_OPEN < 0x10000) entry(place(start, 0), 0x20, kY);
    ram.write(DPRAM_READ_START, static_cast<std::uint16_t>(start));
    ram.write(DPRAM_READ_SIZE, 1);
    background(2);
    return ready();
  };
  ASSERT_EQ(host("WY$20,$123 WY$60000,0"), "");
  EXPECT_TRUE(show_at(0x3BAE));
  EXPECT_EQ(dpram_read_item(0xFFFC), 0x123U);
  EXPECT_TRUE(show_at(0x3BAF)) << "its data have no place";
  EXPECT_FALSE(show_at(0x3BB0));
  EXPECT_FALSE(show_at(0xFFFF));
}

TEST_F(DpramVariables, AListToBeWrittenEndsWithTheRam) {
  ASSERT_EQ(host("WY$20,0"), "");
  const auto write_at = [this](unsigned start) {
    entry(place(start, 0), 0x20, kY);
    dpram_write_item(place(start, 1), start);
    ram.write(DPRAM_WRITE_START, static_cast<std::uint16_t>(start));
    ram.write(DPRAM_WRITE_SIZE, 1);
    background(1);
    return host("RHY$20");
  };
  EXPECT_EQ(write_at(0x3BAD), "3BAD") << "three items of four bytes";
  EXPECT_EQ(write_at(0x3BAE), "3BAD") << "its value's second half has no place";
}

TEST_F(DpramVariables, AnyListIsSurvived) {
  std::mt19937 random(brick::random_seed(3));
  for (int i = 0; i < 2000; ++i) {
    for (int n = 0; n < 20; ++n) ram.write(DPRAM_OPEN + 2 * (random() % 0x500), static_cast<std::uint16_t>(random()));
    ram.write(DPRAM_READ_CONTROL, static_cast<std::uint16_t>(random()));
    ram.write(DPRAM_READ_START, static_cast<std::uint16_t>(random() % 4 == 0 ? random() : random() % 0x280));
    ram.write(DPRAM_READ_SIZE, static_cast<std::uint16_t>(random() % 160));
    background(1);
  }
  ram.write(DPRAM_READ_SIZE, 0);
  EXPECT_EQ(host("P1=4 P1"), "4");
}

}  // namespace
