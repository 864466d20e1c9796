// A CPU with a small program and the debugger's server, run by a thread of its own; the test is the debugger, over a
// socket.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <asio.hpp>

#include "systemc/cpu/gdb_server.h"
#include "testbench/unit/covers.h"
#include "testbench/unit/cpu/assembler.h"

namespace brick {

constexpr std::uint32_t kCode = 0x1000'0000, kData = 0x2000'0000, kPmac = 0xC000'0000;

class GdbBench : public ::testing::Test {
 protected:
  GdbBench() {
    cpu.map(kCode, 0x1000, {});
    cpu.map(kData, 0x1000, {});
    cpu.map(kPmac, 0x1000, {false, true, 0});
    using namespace rv;
    // Counts in a0 and stores the count, for ever.
    const std::vector<Word> program = {
        lui(a1, kData >> 12),       // +0
        addi(a0, a0, 1),            // +4
        rv::s(2, a0, a1, 8),        // +8: sw a0, 8(a1)
        rv::i(0x03, 2, a2, a1, 4),  // +12: lw a2, 4(a1)
        jal(zero, -12),             // +16: to +4
    };
    std::memcpy(cpu.memory(kCode, 32), program.data(), 4 * program.size());
    cpu.reset(kCode);
    server = std::make_unique<GdbServer>(cpu, static_cast<std::uint16_t>(0));
    runner = std::thread([this] {
      try {
        while (!done) {
          server->run(cpu.cycle() + 1000);
          executed = cpu.instructions();
        }
      } catch (const GdbKilled&) { killed = true; }
      ended = true;
    });
    socket.connect({asio::ip::address_v4::loopback(), server->port()});
  }

  ~GdbBench() override { finish(); }

  void finish() {
    done = true;
    asio::error_code ignored;
    socket.close(ignored);  // a stopped program goes on
    if (runner.joinable()) runner.join();
  }

  void write(const std::string& bytes) { asio::write(socket, asio::buffer(bytes)); }

  static std::string framed(const std::string& data) {
    unsigned sum = 0;
    for (const char c : data) sum += static_cast<unsigned char>(c);
    char end[8];
    std::snprintf(end, sizeof end, "#%02x", sum & 0xFF);
    return "$" + data + end;
  }

  char get() {
    char c = 0;
    asio::error_code error;
    asio::read(socket, asio::buffer(&c, 1), error);
    return error ? '\0' : c;
  }

  // The next packet, without what is around it.
  std::string reply() {
    char c = get();
    while (c != '$' && c != '\0') c = get();
    std::string data;
    for (c = get(); c != '#' && c != '\0'; c = get()) data += c;
    get();
    get();
    return data;
  }

  std::string ask(const std::string& packet) {
    write(framed(packet));
    return reply();
  }

  // A word as a packet shows it: in the order of memory.
  static std::string shown(std::uint32_t v) {
    char text[16];
    std::snprintf(text, sizeof text, "%02x%02x%02x%02x", v & 0xFF, v >> 8 & 0xFF, v >> 16 & 0xFF, v >> 24);
    return text;
  }

  // Until the program runs, as its own thread says; false after ten seconds.
  bool runs_beyond(std::uint64_t instructions) const {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (executed <= instructions && std::chrono::steady_clock::now() < limit) std::this_thread::yield();
    return executed > instructions;
  }

  Cpu cpu;
  std::unique_ptr<GdbServer> server;
  std::atomic<std::uint64_t> executed{0};  // instructions, when the server last came back
  std::atomic<bool> done{false}, killed{false}, ended{false};
  std::thread runner;
  asio::io_context io;
  asio::ip::tcp::socket socket{io};
};

}  // namespace brick
