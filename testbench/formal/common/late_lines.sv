// Lines of the bus at the board: each comes at once or two steps after the CPU has moved it, always the same. Pads and
// wires take up to 8.477 ns (host-bus:2.6), of which the ends are the worst.
`default_nettype none

module late_lines #(
  parameter int unsigned Width = 1,
  parameter logic [Width-1:0] Idle = '0  // the levels before a run
) (
  input  wire logic [Width-1:0] now_i,
  output logic [Width-1:0]      there_o,
  output logic [Width-1:0]      late_o
);

  (* anyconst *) logic [Width-1:0] late;
  logic [Width-1:0] one_q = Idle, two_q = Idle;
  always @($global_clock) {one_q, two_q} <= {now_i, one_q};
  assign there_o = (late & two_q) | (~late & now_i);
  assign late_o  = late;

endmodule : late_lines

`default_nettype wire
