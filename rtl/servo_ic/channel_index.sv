// Index conditioning: gating by A and B, and de-multiplexing of a C line that carries C, U, V, W by AB state.
// Also the encoder-loss detector: T and U, V and W are complements. Clock clk_ref_i, asynchronous reset.
`default_nettype none

module channel_index (
  input  wire logic         clk_ref_i,
  input  wire logic         rst_ni,
  input  wire logic         ce_i,         // SCLK
  input  wire logic         ready_i,
  input  wire logic [23:12] level_i,      // filtered inputs, as in the status word
  input  wire logic         gated_i,      // I7mn4
  input  wire logic         gate_low_i,   // I7mn5 bit 0
  input  wire logic         demux_i,      // I7mn5 bit 1
  output logic [23:12]      level_o,      // with C, U, V, W replaced while de-multiplexing
  output logic              index_o,      // at SCLK only
  output logic              incomplete_o, // not all four AB states seen since reset
  output logic              loss_o        // this edge sees an encoder loss
);

  localparam int A = brick_regs_pkg::ServoChannelStatusChaLsb;
  localparam int B = brick_regs_pkg::ServoChannelStatusChbLsb;
  localparam int C = brick_regs_pkg::ServoChannelStatusChcLsb;
  localparam int T = brick_regs_pkg::ServoChannelStatusFlagTLsb;
  localparam int U = brick_regs_pkg::ServoChannelStatusFlagULsb;
  localparam int V = brick_regs_pkg::ServoChannelStatusFlagVLsb;
  localparam int W = brick_regs_pkg::ServoChannelStatusFlagWLsb;

  // States of {A, B} in which the line carries each.
  localparam logic [1:0] StateC = 2'b11;
  localparam logic [1:0] StateU = 2'b10;
  localparam logic [1:0] StateV = 2'b00;
  localparam logic [1:0] StateW = 2'b01;

  logic       a, b, c;
  logic [3:0] seen_q, part_q, part, state;  // per AB state, and C in that state: bit 0 W, 1 V, 2 U, 3 C
  assign a = level_i[A];
  assign b = level_i[B];
  assign state = {{a, b} == StateC, {a, b} == StateU, {a, b} == StateV, {a, b} == StateW};
  assign part  = (part_q & ~state) | (state & {4{level_i[C]}});
  assign c = demux_i ? part[3] : level_i[C];

  logic equal, equal_q;
  // Nobody looks at these between two SCLK edges: docs/simulation-speed.md.
  always_comb begin
    equal   = 1'b0;
    index_o = 1'b0;
    if (ce_i) begin
      equal   = (level_i[T] == level_i[U]) | (level_i[V] == level_i[W]);
      index_o = gated_i ? c & (gate_low_i ? ~a & ~b : a & b) : c;
    end
  end
  assign loss_o = ready_i & equal & equal_q;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      seen_q  <= 4'd0;
      part_q  <= 4'd0;
      equal_q <= 1'b0;
    end else if (ce_i && ready_i) begin
      seen_q  <= seen_q | state;
      part_q  <= part;
      equal_q <= equal;
    end
  end

  always_comb begin
    level_o    = level_i;
    level_o[C] = c;
    if (demux_i) {level_o[U], level_o[V], level_o[W]} = part[2:0];
  end
  assign incomplete_o = seen_q != 4'hF;

endmodule : channel_index

`default_nettype wire
