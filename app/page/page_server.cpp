#include "app/page/page_server.h"

#include <pthread.h>
#include <time.h>
#include <atomic>
#include <exception>
#include <iostream>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <boost/asio.hpp>

#include "app/page/page_session.h"
#include "app/page/site.h"
#include "app/place.h"
#include "systemc/core/usage_error.h"

namespace brick {

namespace net = boost::asio;
using net::ip::tcp;

namespace {

constexpr std::chrono::milliseconds kAcceptPause{100};

Place place_of(const std::string& text) {
  const bool port_alone = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  return parse_place("--page", port_alone ? "127.0.0.1:" + text : text, "127.0.0.1:8080");
}

}  // namespace

struct PageServer::Impl {
  using Session = std::shared_ptr<PageSession>;

  Impl(PageServer& server, const Options& options) : owner(server), place(place_of(options.place)) {
    listen(options.place);
    const tcp::endpoint bound = acceptor.local_endpoint();
    rules = std::make_unique<PageRules>(place.host, bound.address().to_string(), bound.port(), random_token());
    const std::string nonce = random_token();
    site = std::make_unique<PageSite>(PageSite{*rules, site_html(nonce, options.read_only), site_policy(nonce),
                                               options.about, options.read_only, kMostCommands});
  }

  void listen(const std::string& text);
  void accept();
  void take(tcp::socket socket);
  void make_room();
  bool opened(Client client);
  void forget(Client client);
  void deliver();
  void serve();

  PageServer& owner;
  const Place place;
  net::io_context io;
  tcp::acceptor acceptor{io};
  net::steady_timer pause{io};
  std::unique_ptr<PageRules> rules;
  std::unique_ptr<PageSite> site;
  std::map<Client, Session> sessions;  // the oldest first
  std::map<Client, Session> viewing;
  Client last = 0;
  std::atomic<std::size_t> viewers{0};
  std::mutex mailbox;
  std::shared_ptr<const std::string> newest;  // in the mailbox
  std::thread thread;
};

void PageServer::Impl::listen(const std::string& text) try {
  const auto found = tcp::resolver(io).resolve(place.host, place.port, tcp::resolver::numeric_service);
  const tcp::endpoint endpoint = found.begin()->endpoint();
  acceptor.open(endpoint.protocol());
  acceptor.set_option(tcp::acceptor::reuse_address(true));
  if (endpoint.address().is_v6() && endpoint.address().is_unspecified()) acceptor.set_option(net::ip::v6_only(false));
  acceptor.bind(endpoint);
  acceptor.listen();
} catch (const boost::system::system_error& e) {
  throw UsageError(fmt::format("--page {}: {}; expected a free port of this machine", text, e.code().message()));
}

void PageServer::Impl::accept() {
  acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
    if (error == net::error::operation_aborted) return;
    if (!error) {
      take(std::move(socket));
      return accept();
    }
    pause.expires_after(kAcceptPause);  // no more file descriptors, for example
    pause.async_wait([this](boost::system::error_code stopped) {
      if (!stopped) accept();
    });
  });
}

// Who only connects does not keep others out.
void PageServer::Impl::make_room() {
  if (sessions.size() < kMostConnections) return;
  for (const auto& [client, session] : sessions)
    if (viewing.count(client) == 0) return Session(session)->close();
}

void PageServer::Impl::take(tcp::socket socket) {
  make_room();
  const Client client = ++last;
  auto session = std::make_shared<PageSession>(std::move(socket), *site);
  session->on_open = [this, client] { return opened(client); };
  session->on_close = [this, client] { forget(client); };
  session->on_command = [this, client](const PageCommand& command) { owner.on_command(client, command); };
  session->on_watch = [this, client](const PageWatch& watch) { owner.on_watch(client, watch); };
  sessions.emplace(client, session);
  session->start();
}

bool PageServer::Impl::opened(Client client) {
  if (viewing.size() >= kMostViewers) return false;
  const auto found = sessions.find(client);
  if (found == sessions.end() || !viewing.insert(*found).second) return false;
  viewers = viewing.size();
  owner.on_open(client);
  return true;
}

void PageServer::Impl::forget(Client client) {
  sessions.erase(client);
  if (viewing.erase(client) == 0) return;
  viewers = viewing.size();
  owner.on_close(client);
}

void PageServer::Impl::deliver() {
  std::shared_ptr<const std::string> state;
  {
    const std::lock_guard<std::mutex> lock(mailbox);
    state.swap(newest);
  }
  for (const auto& [client, session] : viewing) session->state(state);
}

// What goes wrong with one client ends neither the simulation nor the others.
void PageServer::Impl::serve() {
  for (;;) try {
      io.run();
      return;
    } catch (const std::exception& e) { std::cerr << "brick: page: " << e.what() << std::endl; }
}

PageServer::PageServer(const Options& options) : impl_(std::make_unique<Impl>(*this, options)) {}
PageServer::~PageServer() { stop(); }
std::string PageServer::address() const { return impl_->rules->address(); }
bool PageServer::beyond_loopback() const { return impl_->rules->beyond_loopback(); }
std::size_t PageServer::viewers() const { return impl_->viewers; }

double PageServer::processor_seconds() const {
  clockid_t clock{};
  timespec used{};
  if (impl_->thread.joinable() && pthread_getcpuclockid(impl_->thread.native_handle(), &clock) == 0)
    clock_gettime(clock, &used);
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

void PageServer::start() {
  impl_->accept();
  impl_->thread = std::thread([this] { impl_->serve(); });
}

void PageServer::stop() {
  impl_->io.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
}

void PageServer::publish(std::string state) {
  bool waits = false;
  {
    const std::lock_guard<std::mutex> lock(impl_->mailbox);
    waits = impl_->newest != nullptr;
    impl_->newest = std::make_shared<const std::string>(std::move(state));
  }
  if (!waits) net::post(impl_->io, [this] { impl_->deliver(); });
}

void PageServer::answer(Client client, std::string text) {
  net::post(impl_->io, [this, client, text = std::move(text)]() mutable {
    const auto found = impl_->viewing.find(client);
    if (found != impl_->viewing.end()) Impl::Session(found->second)->answer(std::move(text));
  });
}

}  // namespace brick
