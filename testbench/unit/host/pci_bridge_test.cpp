// The bridge of a PCI board: configuration space, address ranges, byte enables, and the local cycles that come of it
// (host-bus:3.6). The local bus is played by a list of the cycles that were asked for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "systemc/host/pci_bridge.h"
#include "testbench/unit/covers.h"

namespace brick {
namespace {

class LocalCycles : public LocalBus {
 public:
  std::uint8_t read_io(std::uint32_t port) override {
    cycles.push_back(fmt::format("in {:X}", port));
    return static_cast<std::uint8_t>(port);
  }
  void write_io(std::uint32_t port, std::uint8_t value) override {
    cycles.push_back(fmt::format("out {:X} {:02X}", port, value));
  }
  std::uint16_t read_memory(std::uint32_t address, unsigned lanes) override {
    cycles.push_back(fmt::format("read {:X} {}", address, lanes));
    return static_cast<std::uint16_t>(0x1000 + address);
  }
  void write_memory(std::uint32_t address, std::uint16_t value, unsigned lanes) override {
    cycles.push_back(fmt::format("write {:X} {:04X} {}", address, value, lanes));
  }
  bool irq() const override { return interrupt; }
  void bridge_reset() override { ++resets; }

  std::vector<std::string> cycles;
  unsigned resets = 0;
  bool interrupt = false;
};

class PciBridgeTest : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kIo = 0xE000, kMemory = 0xFEB00000;

  PciBridgeTest() {
    bridge_.attach(local_);
    start_up();
  }
  void start_up() {
    configure(PciBridge::kBar0, kIo);
    configure(PciBridge::kBar1, kMemory);
    configure(PciBridge::kCommand, 3);
  }
  // `data` holds the bytes from `address` on; `enables` one bit a byte.
  tlm::tlm_response_status access(PciSpace space, std::uint64_t address, bool write, std::vector<unsigned char>& data,
                                  int enables = -1, bool command = true) {
    PciCommand extension(space);
    std::vector<unsigned char> bytes(data.size());
    for (std::size_t n = 0; n < bytes.size(); ++n) bytes[n] = (enables >> n & 1) != 0 ? TLM_BYTE_ENABLED : 0;
    tlm::tlm_generic_payload payload;
    payload.set_command(write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
    payload.set_address(address);
    payload.set_data_ptr(data.data());
    payload.set_data_length(static_cast<unsigned>(data.size()));
    payload.set_streaming_width(static_cast<unsigned>(data.size()));
    if (enables >= 0) {
      payload.set_byte_enable_ptr(bytes.data());
      payload.set_byte_enable_length(static_cast<unsigned>(bytes.size()));
    }
    if (command) payload.set_extension(&extension);
    sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
    target_->transport(payload, delay);
    if (command) payload.clear_extension(&extension);
    return payload.get_response_status();
  }
  std::uint32_t read(PciSpace space, std::uint64_t address, unsigned length, int enables = -1) {
    std::vector<unsigned char> data(length);
    EXPECT_EQ(access(space, address, false, data, enables), tlm::TLM_OK_RESPONSE);
    std::uint32_t value = 0;
    for (unsigned n = 0; n < length; ++n) value |= static_cast<std::uint32_t>(data[n]) << 8 * n;
    return value;
  }
  void write(PciSpace space, std::uint64_t address, std::uint32_t value, unsigned length, int enables = -1) {
    std::vector<unsigned char> data;
    for (unsigned n = 0; n < length; ++n) data.push_back(static_cast<unsigned char>(value >> 8 * n));
    EXPECT_EQ(access(space, address, true, data, enables), tlm::TLM_OK_RESPONSE);
  }
  std::uint32_t configuration(std::uint32_t address) { return read(PciSpace::kConfiguration, address, 4); }
  void configure(std::uint32_t address, std::uint32_t value) { write(PciSpace::kConfiguration, address, value, 4); }
  tlm::tlm_response_status try_read(PciSpace space, std::uint64_t address, unsigned length = 1) {
    std::vector<unsigned char> data(length);
    return access(space, address, false, data);
  }

  LocalCycles local_;
  PciBridge bridge_{
      sc_core::sc_gen_unique_name("bridge"), {0x210, 0xD0000, 0x10000}, {0x1234, 0x5678, 0x9ABC, 0xDEF0, 7}};
  PciBridge* target_ = &bridge_;  // of access()
};

// Whoever made the local cycles is gone: power-on tells nobody, INTA# is high.
TEST_F(PciBridgeTest, BusThatHasLeftIsNotCalled) {
  LocalCycles other;
  bridge_.attach(other);
  bridge_.detach(local_);  // replaced long ago
  bridge_.reset();
  EXPECT_EQ(other.resets, 1u);
  other.interrupt = true;
  EXPECT_FALSE(bridge_.inta_n());
  bridge_.detach(other);
  bridge_.reset();
  EXPECT_EQ(other.resets + local_.resets, 1u);
  EXPECT_TRUE(bridge_.inta_n());
}

TEST_F(PciBridgeTest, ConfigurationSpaceSaysWhatItIs) {
  EXPECT_EQ(configuration(PciBridge::kId), 0x56781234u);
  EXPECT_EQ(configuration(PciBridge::kSubsystem), 0xDEF09ABCu);
  EXPECT_EQ(configuration(PciBridge::kClass), 0x06800007u) << "a bridge of no other kind, and its revision";
  EXPECT_EQ(configuration(PciBridge::kCommand), 0x02000003u) << "medium DEVSEL; I/O and memory are on";
  EXPECT_EQ(configuration(PciBridge::kInterrupt), 0x0100u) << "INTA#";
  configure(PciBridge::kInterrupt, 11);
  EXPECT_EQ(configuration(PciBridge::kInterrupt), 0x010Bu);
  EXPECT_EQ(configuration(0x18), 0u);
  EXPECT_EQ(read(PciSpace::kConfiguration, PciBridge::kId + 2, 2), 0x5678u);
}

// host-bus:3.6/6: parameters; where none are given vendor $D17A, which is nobody's, and revision 0.
TEST_F(PciBridgeTest, TheNumbersAreItsOwnWhereNoneAreGiven) {
  PciBridge plain(sc_core::sc_gen_unique_name("plain"), {0x210, 0xD0000, 0x10000});
  target_ = &plain;
  EXPECT_EQ(configuration(PciBridge::kId), 0x0001D17Au);
  EXPECT_EQ(configuration(PciBridge::kSubsystem), 0x0001D17Au);
  EXPECT_EQ(configuration(PciBridge::kClass), 0x06800000u);
}

// host-bus:3.6/4: until the computer's start-up has been there nobody answers but the configuration space.
TEST_F(PciBridgeTest, NothingIsEnabledAfterPowerOn) {
  PciBridge fresh("fresh", {0x210, 0xD0000, 0x10000});
  for (const auto& [space, address] :
       {std::pair{PciSpace::kIo, 0u}, {PciSpace::kMemory, 0u}, {PciSpace::kConfiguration, PciBridge::kCommand + 0u}}) {
    unsigned char data[2] = {0xFF, 0xFF};
    PciCommand command(space);
    tlm::tlm_generic_payload payload;
    payload.set_command(tlm::TLM_READ_COMMAND);
    payload.set_address(address);
    payload.set_data_ptr(data);
    payload.set_data_length(2);
    payload.set_streaming_width(2);
    payload.set_extension(&command);
    fresh.attach(local_);
    sc_core::sc_time delay;
    fresh.transport(payload, delay);
    payload.clear_extension(&command);
    EXPECT_EQ(payload.is_response_ok(), space == PciSpace::kConfiguration);
    if (space == PciSpace::kConfiguration) { EXPECT_EQ(data[0] & 3, 0); }
  }
  EXPECT_THAT(local_.cycles, ::testing::IsEmpty());
}

TEST_F(PciBridgeTest, OnesWrittenToABarTellItsSize) {
  configure(PciBridge::kBar0, 0xFFFFFFFF);
  configure(PciBridge::kBar1, 0xFFFFFFFF);
  EXPECT_EQ(configuration(PciBridge::kBar0), 0xFFFFFFF1u) << "16 bytes of I/O";
  EXPECT_EQ(configuration(PciBridge::kBar1), 0xFFFF0000u) << "64 KiB of memory, 32 bits, not prefetchable";
}

// host-bus:3.6/2: 16 KiB where the board has such a window.
TEST_F(PciBridgeTest, BarOfTheMemoryIsAsLongAsItsWindow) {
  PciBridge small(sc_core::sc_gen_unique_name("small"), {0x210, 0xD4000, 0x4000});
  small.attach(local_);
  target_ = &small;
  configure(PciBridge::kBar1, 0xFFFFFFFF);
  EXPECT_EQ(configuration(PciBridge::kBar1), 0xFFFFC000u);
  start_up();
  EXPECT_EQ(try_read(PciSpace::kMemory, kMemory + 0x3FFF), tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(try_read(PciSpace::kMemory, kMemory + 0x4000), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_THAT(local_.cycles, ::testing::ElementsAre("read D7FFE 2"));
}

// Of the command register two bits count; the identity and what is not there take no write. A byte or two of a register
// change these alone.
TEST_F(PciBridgeTest, OnlyWhatIsTheStartUpsIsWritten) {
  for (const std::uint32_t address : {0x00u, 0x08u, 0x0Cu, 0x18u, 0x2Cu, 0x30u}) {
    const std::uint32_t before = configuration(address);
    configure(address, ~before);
    EXPECT_EQ(configuration(address), before) << std::hex << address;
  }
  configure(PciBridge::kCommand, 0xFFFFFFFF);
  EXPECT_EQ(configuration(PciBridge::kCommand), 0x02000003u);
  write(PciSpace::kConfiguration, PciBridge::kCommand, 2, 1);
  EXPECT_EQ(configuration(PciBridge::kCommand), 0x02000002u);
  write(PciSpace::kConfiguration, PciBridge::kCommand + 1, 1, 1);
  EXPECT_EQ(configuration(PciBridge::kCommand), 0x02000002u);
  write(PciSpace::kConfiguration, PciBridge::kBar1 + 2, 0x1234, 2);
  EXPECT_EQ(configuration(PciBridge::kBar1), 0x12340000u);
  write(PciSpace::kConfiguration, PciBridge::kBar0 + 1, 0xAB, 1);
  EXPECT_EQ(configuration(PciBridge::kBar0), 0xAB01u);
  configure(PciBridge::kInterrupt, 0xFFFFFF0B);
  write(PciSpace::kConfiguration, PciBridge::kInterrupt + 1, 0x55, 1);
  EXPECT_EQ(configuration(PciBridge::kInterrupt), 0x010Bu);
  for (const std::uint32_t address : {0x10u, 0x14u, 0x30u}) configure(address, 0x56780001);
  EXPECT_EQ(configuration(PciBridge::kCommand), 0x02000002u) << "each has its own";
  EXPECT_EQ(configuration(PciBridge::kInterrupt), 0x010Bu);
  EXPECT_EQ(read(PciSpace::kConfiguration, 0xFF, 1), 0u) << "the last byte";
  EXPECT_EQ(read(PciSpace::kConfiguration, PciBridge::kSubsystem + 1, 2), 0xF09Au);
  EXPECT_THAT(local_.cycles, ::testing::IsEmpty());
}

// Before anybody makes local cycles the start-up finds the board, and nothing behind it.
TEST_F(PciBridgeTest, WithoutALocalBusTheConfigurationSpaceAloneAnswers) {
  bridge_.detach(local_);
  EXPECT_EQ(configuration(PciBridge::kId), 0x56781234u);
  EXPECT_EQ(try_read(PciSpace::kIo, kIo), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_EQ(try_read(PciSpace::kMemory, kMemory), tlm::TLM_ADDRESS_ERROR_RESPONSE);
}

// Enables that are shorter than the data begin again, as TLM has it; each byte stands at its place in the DWORD.
TEST_F(PciBridgeTest, ShortEnablesRepeatAndPartsOfADwordKeepTheirPlace) {
  write(PciSpace::kIo, kIo + 6, 0xBBAA, 2);
  write(PciSpace::kIo, kIo + 5, 0xCCBBAA, 3, 0b101);
  EXPECT_EQ(read(PciSpace::kIo, kIo + 5, 2), 0x1615u);
  write(PciSpace::kMemory, kMemory + 5, 0xCCBBAA, 3);
  EXPECT_THAT(local_.cycles, ::testing::ElementsAre("out 216 AA", "out 217 BB", "out 215 AA", "out 217 CC", "in 215",
                                                    "in 216", "write D0004 AA00 2", "write D0006 CCBB 3"));
  local_.cycles.clear();
  unsigned char data[4] = {1, 2, 3, 4}, enables[2] = {TLM_BYTE_ENABLED, 0};
  PciCommand command(PciSpace::kIo);
  tlm::tlm_generic_payload payload;
  payload.set_command(tlm::TLM_WRITE_COMMAND);
  payload.set_address(kIo);
  payload.set_data_ptr(data);
  payload.set_data_length(4);
  payload.set_streaming_width(4);
  payload.set_byte_enable_ptr(enables);
  payload.set_byte_enable_length(2);
  payload.set_extension(&command);
  sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
  bridge_.transport(payload, delay);
  payload.clear_extension(&command);
  EXPECT_THAT(local_.cycles, ::testing::ElementsAre("out 210 01", "out 212 03"));
}

// A payload that is copied says the same space.
TEST(PciBridgeCommand, IsCopiedWithItsPayload) {
  const PciCommand command(PciSpace::kIo);
  PciCommand other;
  EXPECT_EQ(other.space, PciSpace::kMemory);
  other.copy_from(command);
  EXPECT_EQ(other.space, PciSpace::kIo);
  tlm::tlm_extension_base* clone = command.clone();
  EXPECT_EQ(static_cast<PciCommand*>(clone)->space, PciSpace::kIo);
  clone->free();
}

TEST_F(PciBridgeTest, IoIsBytesOnTheLocalBus) {
  EXPECT_EQ(read(PciSpace::kIo, kIo + 2, 1), 0x12u);
  write(PciSpace::kIo, kIo + 7, 0x41, 1);
  EXPECT_EQ(read(PciSpace::kIo, kIo + 4, 4), 0x17161514u);
  write(PciSpace::kIo, kIo + 4, 0x44332211, 4, 0b1010);
  EXPECT_EQ(read(PciSpace::kIo, kIo + 15, 1), 0x1Fu);
  EXPECT_THAT(local_.cycles, ::testing::ElementsAre("in 212", "out 217 41", "in 214", "in 215", "in 216", "in 217",
                                                    "out 215 22", "out 217 44", "in 21F"));
}

TEST_F(PciBridgeTest, MemoryIsHalfWordsTheLowOneFirst) {
  EXPECT_EQ(read(PciSpace::kMemory, kMemory + 0x1050, 4), 0x20522050u) << "low halves of 0x1000 + address";
  write(PciSpace::kMemory, kMemory + 8, 0x44332211, 4);
  EXPECT_THAT(local_.cycles,
              ::testing::ElementsAre("read D1050 3", "read D1052 3", "write D0008 2211 3", "write D000A 4433 3"));
  local_.cycles.clear();
  write(PciSpace::kMemory, kMemory + 8, 0x44332211, 4, 0b0110);
  write(PciSpace::kMemory, kMemory + 8, 0x44332211, 4, 0b1000);
  write(PciSpace::kMemory, kMemory + 8, 0x44332211, 4, 0);
  write(PciSpace::kMemory, kMemory + 0xFFFF, 0x55, 1);
  read(PciSpace::kMemory, kMemory + 2, 2);
  EXPECT_THAT(local_.cycles, ::testing::ElementsAre("write D0008 2211 2", "write D000A 4433 1", "write D000A 4433 2",
                                                    "write DFFFE 5500 2", "read D0002 3"));
}

TEST_F(PciBridgeTest, ByteEnablesCountInReadsAndInTheConfigurationSpaceToo) {
  write(PciSpace::kConfiguration, PciBridge::kBar1, 0x12345678, 4, 0b1000);
  EXPECT_EQ(configuration(PciBridge::kBar1), (kMemory & 0xFFFFFF) | 0x12000000);
  std::vector<unsigned char> data(4, 0x5A);
  EXPECT_EQ(access(PciSpace::kIo, kIo + 4, false, data, 0b0101), tlm::TLM_OK_RESPONSE);
  EXPECT_THAT(data, ::testing::ElementsAre(0x14, 0x5A, 0x16, 0x5A));
  EXPECT_THAT(local_.cycles, ::testing::ElementsAre("in 214", "in 216"));
}

TEST_F(PciBridgeTest, NobodyAnswersOutsideTheRangesOrWithoutEnable) {
  using Space = PciSpace;
  for (const auto& [space, address] : std::vector<std::pair<Space, std::uint64_t>>{{Space::kIo, kIo - 1},
                                                                                   {Space::kIo, kIo + 16},
                                                                                   {Space::kMemory, kMemory - 1},
                                                                                   {Space::kMemory, kMemory + 0x10000},
                                                                                   {Space::kIo, kMemory},
                                                                                   {Space::kConfiguration, 256}})
    EXPECT_EQ(try_read(space, address), tlm::TLM_ADDRESS_ERROR_RESPONSE) << std::hex << address;
  configure(PciBridge::kCommand, PciBridge::kMemoryEnable);
  EXPECT_EQ(try_read(Space::kIo, kIo), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_EQ(try_read(Space::kMemory, kMemory), tlm::TLM_OK_RESPONSE);
  configure(PciBridge::kCommand, PciBridge::kIoEnable);
  EXPECT_EQ(try_read(Space::kIo, kIo), tlm::TLM_OK_RESPONSE);
  EXPECT_EQ(try_read(Space::kMemory, kMemory), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_EQ(local_.cycles.size(), 2u);
}

TEST_F(PciBridgeTest, BurstsAndPayloadsWithoutCommandAreRefused) {
  EXPECT_EQ(try_read(PciSpace::kMemory, kMemory, 8), tlm::TLM_BURST_ERROR_RESPONSE);
  EXPECT_EQ(try_read(PciSpace::kMemory, kMemory + 2, 4), tlm::TLM_BURST_ERROR_RESPONSE);
  std::vector<unsigned char> data(4);
  EXPECT_EQ(access(PciSpace::kMemory, kMemory, false, data, -1, false), tlm::TLM_COMMAND_ERROR_RESPONSE);
  EXPECT_TRUE(local_.cycles.empty());
}

// A payload of one byte with one attribute changed; nothing moves, not even in its data.
TEST_F(PciBridgeTest, PayloadsThatTlmForbidsAreAnsweredAsItDemands) {
  using Payload = tlm::tlm_generic_payload;
  unsigned char byte = 0x5A, enable = TLM_BYTE_ENABLED;
  const struct {
    const char* what;
    std::function<void(Payload&)> edit;
    tlm::tlm_response_status expected;
  } cases[] = {
      {"nothing", [](Payload&) {}, tlm::TLM_OK_RESPONSE},
      {"no length", [](Payload& p) { p.set_data_length(0); }, tlm::TLM_BURST_ERROR_RESPONSE},
      {"no streaming width", [](Payload& p) { p.set_streaming_width(0); }, tlm::TLM_BURST_ERROR_RESPONSE},
      {"streamed", [](Payload& p) { p.set_data_length(2), p.set_streaming_width(1); }, tlm::TLM_BURST_ERROR_RESPONSE},
      {"wide stream", [](Payload& p) { p.set_streaming_width(4); }, tlm::TLM_OK_RESPONSE},
      {"burst", [](Payload& p) { p.set_data_length(5), p.set_streaming_width(5); }, tlm::TLM_BURST_ERROR_RESPONSE},
      {"enables of no length", [&](Payload& p) { p.set_byte_enable_ptr(&enable); },
       tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE},
      {"enables", [&](Payload& p) { p.set_byte_enable_ptr(&enable), p.set_byte_enable_length(1); },
       tlm::TLM_OK_RESPONSE},
      {"length without enables", [](Payload& p) { p.set_byte_enable_length(1); }, tlm::TLM_OK_RESPONSE},
      {"no data", [](Payload& p) { p.set_data_ptr(nullptr); }, tlm::TLM_GENERIC_ERROR_RESPONSE},
      {"no command", [](Payload& p) { p.set_command(tlm::TLM_IGNORE_COMMAND); }, tlm::TLM_COMMAND_ERROR_RESPONSE},
      {"beyond 32 bits", [](Payload& p) { p.set_address(p.get_address() | 1ull << 32); },
       tlm::TLM_ADDRESS_ERROR_RESPONSE},
  };
  for (const auto& c : cases) {
    for (const auto command : {tlm::TLM_READ_COMMAND, tlm::TLM_WRITE_COMMAND}) {
      PciCommand extension(PciSpace::kIo);
      Payload payload;
      payload.set_command(command);
      payload.set_address(kIo);
      payload.set_data_ptr(&byte);
      payload.set_data_length(1);
      payload.set_streaming_width(1);
      payload.set_extension(&extension);
      c.edit(payload);
      byte = 0x5A;
      local_.cycles.clear();
      sc_core::sc_time delay = sc_core::SC_ZERO_TIME;
      bridge_.transport(payload, delay);
      payload.clear_extension(&extension);
      const bool good = c.expected == tlm::TLM_OK_RESPONSE;
      EXPECT_EQ(payload.get_response_status(), c.expected) << c.what;
      EXPECT_EQ(local_.cycles.size(), good ? 1u : 0u) << c.what;
      EXPECT_EQ(byte, good && command == tlm::TLM_READ_COMMAND ? 0x10 : 0x5A) << c.what;
    }
  }
}

// host-bus:3.6/4
TEST_F(PciBridgeTest, PowerOnForgetsTheRangesAndAsksForNewOnes) {
  configure(PciBridge::kInterrupt, 11);
  bridge_.reset();
  EXPECT_EQ(local_.resets, 1u);
  EXPECT_EQ(configuration(PciBridge::kCommand) & 3, 0u);
  EXPECT_EQ(configuration(PciBridge::kBar0), 1u);
  EXPECT_EQ(configuration(PciBridge::kBar1), 0u);
  EXPECT_EQ(configuration(PciBridge::kInterrupt), 0x0100u);
  EXPECT_EQ(try_read(PciSpace::kIo, kIo), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  EXPECT_EQ(try_read(PciSpace::kMemory, kMemory), tlm::TLM_ADDRESS_ERROR_RESPONSE);
  start_up();
  EXPECT_EQ(try_read(PciSpace::kIo, kIo), tlm::TLM_OK_RESPONSE);
}

TEST_F(PciBridgeTest, IntaIsLowWhileTheBoardInterrupts) {
  EXPECT_TRUE(bridge_.inta_n());
  local_.interrupt = true;
  EXPECT_FALSE(bridge_.inta_n());
}

}  // namespace
}  // namespace brick
