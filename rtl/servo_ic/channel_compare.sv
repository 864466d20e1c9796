// Position compare: EQU toggles when the counter leaves compare A or B (or, by EquOnLeave, arrives there), and the
// other of the two moves by the increment in the direction of travel. With hardware 1/T, position and compares have 12
// fraction bits and EQU toggles when the position passes. A register write beats a step at the same edge. Clock
// clk_ref_i, asynchronous reset. docs/servo_channel.md, Compare.
`default_nettype none

module channel_compare #(
  parameter bit EquOnLeave = 1'b1  // 0: EQU toggles when the counter arrives at equality
) (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        ce_i,         // SCLK
  input  wire logic        fine_i,       // I7mn9
  input  wire logic        other_i,      // I7mn1; the source below is chosen outside
  input  wire logic        source_fine_i,  // I7mn9 of the source
  input  wire logic        count_i,      // the source counts at this edge
  input  wire logic        down_i,
  input  wire logic        still_i,      // what the source does here is no motion
  input  wire logic [23:0] counter_i,    // position of the source before this edge
  input  wire logic [11:0] fraction_i,
  input  wire logic [5:0]  we_i,         // bit 0 A, 1 B, 2 increment, 3 fraction of A, 4 fraction of B, 5 EQU
  input  wire logic [23:0] wdata_i,
  input  wire logic        trip_d_i,     // the watchdog trips with the coming edge, or has: EQU is 0
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

  // Passing, with fractions: from `last` to `pos` the position crossed a compare if it was not beyond it before and is
  // now. Arriving: if it was before it and is not now, the same one unit later.
  localparam logic [35:0] ArrivesLater = EquOnLeave ? 36'd0 : 36'd1;
  logic [35:0] last_q, pos, a_ahead, b_ahead;
  logic [13:0] moved;  // at most a count and, of the fraction, less than another
  logic [12:0] way;
  logic [23:0] at;  // where a count has to find a compare
  logic [1:0]  source_q;
  logic        known_q, jump, looks, back, hit_a, hit_b, down;
  // No motion: a source that is held, and a position that is elsewhere as it is another's or turns to or from 1/T.
  assign jump = still_i || {other_i, source_fine_i} != source_q;
  assign pos     = {counter_i, fraction_i};
  assign moved   = pos[13:0] - last_q[13:0];
  assign back    = moved[13];
  assign way     = back ? -moved[12:0] : moved[12:0];
  assign a_ahead = back ? last_q - {a_q, af_q} : {a_q, af_q} - last_q;
  assign b_ahead = back ? last_q - {b_q, bf_q} : {b_q, bf_q} - last_q;
  assign at      = EquOnLeave ? counter_i : (down_i ? counter_i - 24'd1 : counter_i + 24'd1);
  assign looks   = ce_i & known_q & ~jump;
  assign hit_a   = fine_i ? looks & (a_ahead - ArrivesLater < {23'd0, way}) : count_i & (at == a_q);
  assign hit_b   = fine_i ? looks & (b_ahead - ArrivesLater < {23'd0, way}) : count_i & (at == b_q);
  assign down    = fine_i ? back : down_i;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      a_q   <= 24'd0;
      b_q   <= 24'd0;
      inc_q <= 24'd0;
      af_q  <= 12'd0;
      bf_q  <= 12'd0;
      equ_q <= 1'b0;
    end else begin
      if (hit_b) a_q <= down ? a_q - inc_q : a_q + inc_q;
      if (hit_a) b_q <= down ? b_q - inc_q : b_q + inc_q;
      if (hit_a != hit_b) equ_q <= ~equ_q;
      if (we_i[0]) a_q   <= wdata_i;
      if (we_i[1]) b_q   <= wdata_i;
      if (we_i[2]) inc_q <= wdata_i;
      if (we_i[3]) af_q  <= wdata_i[brick_regs_pkg::ServoChannelFineTimer2CompareALsb +: 12];
      if (we_i[4]) bf_q  <= wdata_i[brick_regs_pkg::ServoChannelFineTimer1CompareBLsb +: 12];
      if (we_i[5]) equ_q <= wdata_i[brick_regs_pkg::ServoChannelControlEquStateLsb];
      if (trip_d_i) equ_q <= 1'b0;
    end
  end

  // No reset: without fine_i the next edge forgets the position.
  always_ff @(posedge clk_ref_i) begin
    if (ce_i) last_q <= pos;
    if (ce_i)                 known_q <= fine_i & ~still_i;
    else if (jump || !fine_i) known_q <= 1'b0;
    source_q <= {other_i, source_fine_i};
  end

  assign a_o          = a_q;
  assign b_o          = b_q;
  assign inc_o        = inc_q;
  assign a_fraction_o = af_q;
  assign b_fraction_o = bf_q;
  assign equ_o        = equ_q;

endmodule : channel_compare

`default_nettype wire
