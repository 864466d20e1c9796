#include "app/ethernet_server.h"

#include <chrono>
#include <map>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <asio.hpp>

#include "app/complaint.h"
#include "app/ethernet_connection.h"
#include "app/place.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace {

using asio::ip::tcp;
using asio::ip::udp;

constexpr int kAttempts = 16;  // to find a port that both protocols have
constexpr std::chrono::milliseconds kAcceptPause{100};

tcp::endpoint endpoint_of(asio::io_context& io, const std::string& place) {
  const auto [host, port] = parse_place("--listen", place, "127.0.0.1:1025");
  asio::error_code error;
  const auto found = tcp::resolver(io).resolve(host, port, tcp::resolver::numeric_service, error);
  if (error)
    throw UsageError(
        fmt::format("--listen {}: {}; expected a name or address of this machine", place, error.message()));
  return found.begin()->endpoint();
}

std::string text_of(const tcp::endpoint& place) {
  const std::string host = place.address().to_string();
  return fmt::format("{}:{}", place.address().is_v6() ? '[' + host + ']' : host, place.port());
}

}  // namespace

struct EthernetServer::Impl {
  explicit Impl(EthernetServer& server) : owner(server) {}

  void listen(const std::string& place);
  void bind(const tcp::endpoint& endpoint);
  void accept();
  void take(tcp::socket socket);
  void receive();
  void take_datagram(std::size_t count);
  Client peer(const udp::endpoint& endpoint);
  void reply(Client client, std::string bytes);
  void forget(Client client);
  void tell(Complaint& complaint, const std::string& what) {
    const std::string text = complaint.text(what);
    if (!text.empty()) owner.on_trouble(text);
  }

  struct Peer {
    udp::endpoint endpoint;
    std::size_t under_way = 0;
    std::uint64_t heard = 0;  // the least is forgotten first
  };

  EthernetServer& owner;
  asio::io_context io;
  tcp::acceptor acceptor{io};
  udp::socket datagrams{io};
  asio::steady_timer pause{io};
  std::map<Client, std::shared_ptr<EthernetConnection>> connections;
  std::map<Client, Peer> peers;
  udp::endpoint sender;
  std::array<char, 2048> datagram{};
  Client last = 0;
  std::uint64_t heard = 0;
  std::atomic<std::size_t> clients{0};
  Complaint refused, broken;
  std::thread thread;
};

// ------------------------------------------------------------------------------------------------------------- sockets

void EthernetServer::Impl::bind(const tcp::endpoint& endpoint) {
  acceptor = tcp::acceptor(io);
  datagrams = udp::socket(io);
  acceptor.open(endpoint.protocol());
  acceptor.set_option(tcp::acceptor::reuse_address(true));
  const bool all = endpoint.address().is_v6() && endpoint.address().is_unspecified();
  if (all) acceptor.set_option(asio::ip::v6_only(false));  // whatever the system's habit is
  acceptor.bind(endpoint);
  const tcp::endpoint bound = acceptor.local_endpoint();
  datagrams.open(bound.address().is_v6() ? udp::v6() : udp::v4());
  if (all) datagrams.set_option(asio::ip::v6_only(false));
  datagrams.bind(udp::endpoint(bound.address(), bound.port()));
  acceptor.listen();
}

void EthernetServer::Impl::listen(const std::string& place) {
  const tcp::endpoint endpoint = endpoint_of(io, place);
  for (int attempt = 1;; ++attempt) try {
      return bind(endpoint);
    } catch (const asio::system_error& e) {
      if (endpoint.port() == 0 && attempt < kAttempts) continue;
      throw UsageError(fmt::format("--listen {}: {}; expected a free port of this machine", place, e.code().message()));
    }
}

// ----------------------------------------------------------------------------------------------------------------- TCP

void EthernetServer::Impl::accept() {
  acceptor.async_accept([this](asio::error_code error, tcp::socket socket) {
    if (!error) {
      take(std::move(socket));
      return accept();
    }
    pause.expires_after(kAcceptPause);  // no more file descriptors, for example
    pause.async_wait([this](asio::error_code) { accept(); });
  });
}

void EthernetServer::Impl::take(tcp::socket socket) {
  if (connections.size() >= kMostClients)  // the socket goes with its end
    return tell(refused, fmt::format("a client is refused: {} are connected", kMostClients));
  const Client client = ++last;
  auto connection = std::make_shared<EthernetConnection>(std::move(socket), kMostRequests);
  connection->on_request = [this, client](const EthernetPacket& packet) { owner.on_request(client, packet); };
  connection->on_close = [this, client](const std::string& why) {
    if (!why.empty()) tell(broken, fmt::format("client {} is cut off: {}", client, why));
    forget(client);
  };
  connections.emplace(client, connection);
  clients = connections.size();
  connection->start();
}

void EthernetServer::Impl::forget(Client client) {
  connections.erase(client);
  peers.erase(client);
  clients = connections.size();
  owner.on_close(client);
}

// ----------------------------------------------------------------------------------------------------------------- UDP

void EthernetServer::Impl::receive() {
  datagrams.async_receive_from(asio::buffer(datagram), sender, [this](asio::error_code error, std::size_t count) {
    if (!error) take_datagram(count);
    receive();
  });
}

EthernetServer::Client EthernetServer::Impl::peer(const udp::endpoint& endpoint) {
  auto oldest = peers.end();
  for (auto at = peers.begin(); at != peers.end(); ++at) {
    const Peer& known = at->second;
    if (known.endpoint == endpoint) return at->first;
    if (known.under_way == 0 && (oldest == peers.end() || known.heard < oldest->second.heard)) oldest = at;
  }
  if (peers.size() >= kMostClients) {
    if (oldest == peers.end()) return 0;
    forget(oldest->first);
  }
  peers[++last].endpoint = endpoint;
  return last;
}

// One packet; what is none, or one too many, is lost, as datagrams may be.
void EthernetServer::Impl::take_datagram(std::size_t count) {
  PacketReader packets;
  packets.take(std::string_view(datagram.data(), count));
  const auto packet = packets.next();
  if (!packet) return;
  const Client client = peer(sender);
  if (client == 0 || peers[client].under_way >= kMostRequests) return;
  peers[client].heard = ++heard;
  ++peers[client].under_way;
  owner.on_request(client, *packet);
}

void EthernetServer::Impl::reply(Client client, std::string bytes) {
  if (const auto found = connections.find(client); found != connections.end())
    return std::shared_ptr<EthernetConnection>(found->second)->reply(std::move(bytes));
  const auto found = peers.find(client);
  if (found == peers.end()) return;
  --found->second.under_way;
  asio::error_code ignored;
  datagrams.send_to(asio::buffer(bytes), found->second.endpoint, 0, ignored);
}

// -------------------------------------------------------------------------------------------------------------- server

EthernetServer::EthernetServer(const std::string& place) : impl_(std::make_unique<Impl>(*this)) {
  impl_->listen(place);
}

EthernetServer::~EthernetServer() { stop(); }

std::string EthernetServer::place() const { return text_of(impl_->acceptor.local_endpoint()); }
std::size_t EthernetServer::clients() const { return impl_->clients; }

void EthernetServer::start() {
  impl_->datagrams.non_blocking(true);
  impl_->accept();
  impl_->receive();
  impl_->thread = std::thread([this] { impl_->io.run(); });
}

void EthernetServer::stop() {
  impl_->io.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
}

void EthernetServer::reply(Client client, std::string bytes) {
  asio::post(impl_->io, [this, client, text = std::move(bytes)]() mutable { impl_->reply(client, std::move(text)); });
}

}  // namespace brick
