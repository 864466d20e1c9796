"""Host software of your own against the Ethernet port. Here it is 20 lines; yours is imported or started."""

import socket
import struct


class Host:
    """Asks a line by the packet GETRESPONSE (docs/datasheet/ethernet.md)."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), 60)

    def ask(self, line: str) -> str:
        self.socket.sendall(struct.pack(">BBHHH", 0x40, 0xBF, 0, 0, len(line)) + line.encode())
        reply = self.socket.recv(1500)
        return reply.rstrip(b"\x06").decode().strip()


def test_host_program(brick_port: int) -> None:
    host = Host(brick_port)
    host.ask("I3=2 I6=1")
    assert host.ask("P1=3 P1") == "3"
    assert "ERR003" in host.ask("frob")
    host.socket.close()
