// Position compare: EQU toggles when the counter leaves compare A or B, and the other of the two moves by the increment in the
// direction of travel. With hardware 1/T, position and compares have 12 fraction bits and EQU toggles when the position passes.
// A register write beats a step at the same edge. Clock clk_ref_i, asynchronous reset. docs/servo_channel.md, Compare.
`default_nettype none

module channel_compare (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        ce_i,         // SCLK
  input  wire logic        fine_i,       // I7mn9
  input  wire logic        other_i,      // I7mn1; the source below is chosen outside
  input  wire logic        count_i,      // the source counts at this edge
  input  wire logic        down_i,
  input  wire logic        hold_i,       // the source is held at 0
  input  wire logic [23:0] counter_i,    // position of the source before this edge
  input  wire logic [11:0] fraction_i,
  input  wire logic [4:0]  we_i,         // bit 0 A, 1 B, 2 increment, 3 fraction of A, 4 fraction of B
  input  wire logic [23:0] wdata_i,
  input  wire logic        equ_we_i,
  input  wire logic        equ_i,
  output logic [23:0]      a_o,
  output logic [23:0]      b_o,
  output logic [23:0]      inc_o,
  output logic [11:0]      a_fraction_o,
  output logic [11:0]      b_fraction_o,
  output logic             equ_o
);

  logic [23:0] a_q, b_q, inc_q;
  logic [11:0] af_q, bf_q;
  logic        equ_q;

  // Passing, with fractions: from `last` to `pos` the position crossed a compare if it was not beyond it before and is now.
  logic [35:0] pos, last_q, delta, back, a_ahead, b_ahead;
  logic        known_q, other_q, moved, backwards, pass_a, pass_b;
  assign pos       = {counter_i, fraction_i};
  assign delta     = pos - last_q;
  assign back      = last_q - pos;
  assign backwards = delta[35];
  assign a_ahead   = backwards ? last_q - {a_q, af_q} : {a_q, af_q} - last_q;
  assign b_ahead   = backwards ? last_q - {b_q, bf_q} : {b_q, bf_q} - last_q;
  assign moved     = ce_i & known_q & ~hold_i & (other_i == other_q);
  assign pass_a    = moved & (a_ahead < (backwards ? back : delta));
  assign pass_b    = moved & (b_ahead < (backwards ? back : delta));

  logic hit_a, hit_b, down;
  assign hit_a = fine_i ? pass_a : count_i & (counter_i == a_q);
  assign hit_b = fine_i ? pass_b : count_i & (counter_i == b_q);
  assign down  = fine_i ? backwards : down_i;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      a_q     <= 24'd0;
      b_q     <= 24'd0;
      inc_q   <= 24'd0;
      af_q    <= 12'd0;
      bf_q    <= 12'd0;
      equ_q   <= 1'b0;
      last_q  <= 36'd0;
      known_q <= 1'b0;
      other_q <= 1'b0;
    end else begin
      if (we_i[0])    a_q <= wdata_i;
      else if (hit_b) a_q <= down ? a_q - inc_q : a_q + inc_q;
      if (we_i[1])    b_q <= wdata_i;
      else if (hit_a) b_q <= down ? b_q - inc_q : b_q + inc_q;
      if (we_i[2])    inc_q <= wdata_i;
      if (we_i[3])    af_q <= wdata_i[11:0];
      if (we_i[4])    bf_q <= wdata_i[11:0];
      if (equ_we_i)   equ_q <= equ_i;
      else            equ_q <= equ_q ^ hit_a ^ hit_b;
      if (ce_i) begin
        last_q  <= fine_i ? pos : 36'd0;
        known_q <= fine_i & ~hold_i;
        other_q <= other_i;
      end
    end
  end

  assign a_o          = a_q;
  assign b_o          = b_q;
  assign inc_o        = inc_q;
  assign a_fraction_o = af_q;
  assign b_fraction_o = bf_q;
  assign equ_o        = equ_q;

endmodule : channel_compare

`default_nettype wire
