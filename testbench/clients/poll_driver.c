/* A host driver for the controller's Ethernet port as control systems have them: asynchronous, never waiting for one
 * connection alone. One connection polls eight axes by a glued line, a second reads out long answers: SENDLINE,
 * READREADY until something waits, GETBUFFER in pieces of 1400 bytes. One recv a reply, judged by its last byte.
 *   poll_driver PORT POLLS LINE...      prints each poll and each answer; 0, or 1 when something is wrong */
#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { DOWNLOAD = 0x40, UPLOAD = 0xC0, HEADER = 8, MOST_DATA = 1492, PIECE = 1400, PATIENCE_MS = 60000 };
enum { SENDLINE = 0xB0, FLUSH = 0xB3, GETRESPONSE = 0xBF, READREADY = 0xC2, GETBUFFER = 0xC5 };
enum { ACKNOWLEDGE = 0x06, BELL = 0x07 };
#define POLL_LINE "#1?PVF#2?PVF#3?PVF#4?PVF#5?PVF#6?PVF#7?PVF#8?PVF"

struct port {
  int socket;
  unsigned char request[HEADER + MOST_DATA];
  size_t length, sent;
  char reply[PIECE + 1];
  void (*replied)(struct port* port, size_t length); /* begins the next request, or ends the work */
  bool working;
  int left;     /* polls */
  char** lines; /* to read out, null at the end */
};

static void fail(const char* what) {
  fprintf(stderr, "poll_driver: %s\n", what);
  exit(1);
}

static void begin(struct port* port, unsigned type, unsigned code, const char* data, size_t wanted) {
  const size_t length = data == NULL ? 0 : strlen(data);
  const size_t field = data == NULL ? wanted : length;
  const unsigned char header[HEADER] = {(unsigned char)type,         (unsigned char)code, 0, 0, 0, 0,
                                        (unsigned char)(field >> 8), (unsigned char)field};
  if (length > MOST_DATA) fail("a line is too long");
  memcpy(port->request, header, HEADER);
  if (length != 0) memcpy(port->request + HEADER, data, length);
  port->length = HEADER + length;
  port->sent = 0;
}

/* The end of an answer: ACK, or CR where BEL has said that it is an error. */
static bool is_whole(const char* text, size_t length) {
  return text[length - 1] == ACKNOWLEDGE || (text[length - 1] == '\r' && memchr(text, BELL, length) != NULL);
}

static void print(const char* text, size_t length) {
  for (size_t i = 0; i < length; ++i)
    if (text[i] == '\r')
      putchar('|');
    else if (text[i] != ACKNOWLEDGE)
      putchar(text[i] == BELL ? '!' : text[i]);
}

/* Polls ------------------------------------------------------------------------------------------------------------ */

static void polled(struct port* port, size_t length) {
  if (!is_whole(port->reply, length)) fail("a poll has no end");
  print(port->reply, length);
  putchar('\n');
  port->working = --port->left > 0;
  if (port->working) begin(port, DOWNLOAD, GETRESPONSE, POLL_LINE, 0);
}

static void poll_set_up(struct port* port, size_t length) {
  if (!is_whole(port->reply, length)) fail("no answer to the first line");
  port->replied = polled;
  begin(port, DOWNLOAD, GETRESPONSE, POLL_LINE, 0);
  port[1].working = true; /* answers are framed by I3 and I6 as that line has set them */
}

/* Long answers ----------------------------------------------------------------------------------------------------- */

static void line_sent(struct port* port, size_t length);
static void looked(struct port* port, size_t length);

static void next_line(struct port* port) {
  port->working = *port->lines != NULL;
  if (!port->working) return;
  port->replied = line_sent;
  begin(port, DOWNLOAD, SENDLINE, *port->lines++, 0);
}

static void look(struct port* port) {
  port->replied = looked;
  begin(port, UPLOAD, READREADY, NULL, 2);
}

static void fetched(struct port* port, size_t length) {
  print(port->reply, length);
  if (!is_whole(port->reply, length)) {
    if (length != PIECE) fail("a short piece in the middle of an answer");
    look(port);
    return;
  }
  putchar('\n');
  next_line(port);
}

static void looked(struct port* port, size_t length) {
  if (length != 2) fail("READREADY has another answer");
  if (port->reply[0] == 0) {
    look(port);
    return;
  }
  port->replied = fetched;
  begin(port, UPLOAD, GETBUFFER, NULL, 2048);
}

static void line_sent(struct port* port, size_t length) {
  if (length != 1 || port->reply[0] != DOWNLOAD) fail("SENDLINE is not confirmed");
  look(port);
}

static void flushed(struct port* port, size_t length) {
  if (length != 1 || port->reply[0] != DOWNLOAD) fail("FLUSH is not confirmed");
  next_line(port);
}

/* Both ------------------------------------------------------------------------------------------------------------- */

static void open_port(struct port* port, uint16_t number) {
  struct sockaddr_in place = {.sin_family = AF_INET, .sin_port = htons(number)};
  const int on = 1;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  port->socket = socket(AF_INET, SOCK_STREAM, 0);
  if (port->socket < 0 || connect(port->socket, (struct sockaddr*)&place, sizeof place) != 0) fail("no connection");
  (void)setsockopt(port->socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

static void serve(struct port* port, short events) {
  if ((events & POLLOUT) != 0) {
    const ssize_t count = send(port->socket, port->request + port->sent, port->length - port->sent, MSG_NOSIGNAL);
    if (count < 0) fail("send");
    port->sent += (size_t)count;
  } else if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) {
    const ssize_t count = recv(port->socket, port->reply, sizeof port->reply, 0);
    if (count <= 0) fail("the connection has ended");
    port->replied(port, (size_t)count);
  }
}

static const char kHelp[] =
    "usage: poll_driver PORT POLLS LINE...\n"
    "Polls eight axes of the controller at 127.0.0.1:PORT POLLS times, and reads out the answers to LINE...\n"
    "beside that. Prints each poll and each answer.\n";

int main(int argc, char** argv) {
  if (argc > 1 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
    fputs(kHelp, stdout);
    return 0;
  }
  if (argc < 3) fail("expected PORT POLLS LINE..., see --help");
  struct port ports[2] = {{.left = atoi(argv[2]), .replied = poll_set_up}, {.lines = argv + 3, .replied = flushed}};
  for (int i = 0; i < 2; ++i) open_port(&ports[i], (uint16_t)atoi(argv[1]));
  ports[0].working = true;
  begin(&ports[0], DOWNLOAD, GETRESPONSE, "i6=1 i3=2 ver", 0);
  begin(&ports[1], DOWNLOAD, FLUSH, NULL, 0);
  while (ports[0].working || ports[1].working) {
    struct pollfd waits[2];
    for (int i = 0; i < 2; ++i) {
      waits[i].fd = ports[i].working ? ports[i].socket : -1;
      waits[i].events = ports[i].sent < ports[i].length ? POLLOUT : POLLIN;
      waits[i].revents = 0;
    }
    if (poll(waits, 2, PATIENCE_MS) <= 0) fail("no reply");
    for (int i = 0; i < 2; ++i)
      if (waits[i].fd >= 0) serve(&ports[i], waits[i].revents);
  }
  for (int i = 0; i < 2; ++i) (void)close(ports[i].socket);
  return 0;
}
