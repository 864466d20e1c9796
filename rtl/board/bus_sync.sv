// Port A synchroniser of the register regions. All pins pass flip-flops on clk_pwm_i; what they mean is decided on
// clk_ref_i. Pins have delays of their own, up to a period of clk_pwm, so an address is looked at only between two
// samples of its strobe: a period or more after one that has found it low, and the strobe must be found low again, with
// no fall in between, a period or more after the address. Then it is that strobe's own address, whatever the delays.
//   the edge of clk_ref that finds a new strobe low and one of our regions selected: address and data are taken
//   the next one: we_o or rd_o, if the strobe was still low at the first; the write is made, a read has its sample
// A strobe of others, or one too short, does nothing. Asynchronous reset of the strobes' two stages, of we_o and rd_o:
// the rest counts with a level that has come through both, and the reset is longer. docs/port_a.md.
`default_nettype none

module bus_sync (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic [1:0]  rd_falls_i,  // of bus_strobes
  input  wire logic [1:0]  wr_falls_i,
  input  wire logic        pa_rd_ni,
  input  wire logic        pa_wr_ni,
  input  wire logic [18:0] pa_addr_i,
  input  wire logic        pa_x_i,
  input  wire logic [3:0]  pa_aa_i,
  input  wire logic        pa_int_i,
  input  wire logic [23:0] pa_wdata_i,
  output logic [18:0]      addr_o,
  output logic             x_o,
  output logic [3:0]       aa_o,
  output logic             int_o,
  output logic [23:0]      wdata_o,
  output logic             we_o,        // one clk_pwm, before the edge of clk_ref
  output logic             rd_o,
  output logic [1:0]       rd_falls_o   // the count of the read whose sample it is
);

  // ---------------------------------------------------------------- clk_pwm: pins
  // Strobes pass two stages and counts a third. The address has one: it counts when it stands.
  logic [1:0]  rd2_q, wr2_q, rd3_q, wr3_q;
  logic        rd_low2_q, wr_low2_q;
  sync2 #(.Width(6)) u_strobe_sync (
    .clk_i (clk_pwm_i), .rst_ni,
    .d_i   ({rd_falls_i, wr_falls_i, ~pa_rd_ni, ~pa_wr_ni}),
    .q_o   ({rd2_q, wr2_q, rd_low2_q, wr_low2_q})
  );
  logic [24:0] pins_q;  // {int, aa, x, addr}
  always_ff @(posedge clk_pwm_i) begin
    {rd3_q, wr3_q} <= {rd2_q, wr2_q};
    pins_q         <= {pa_int_i, pa_aa_i, pa_x_i, pa_addr_i};
  end

  // ---------------------------------------------------------------- clk_ref: address and data
  // A level may come a clock after the fall that it belongs to, so the count of a clock earlier names it.
  logic        own, rd_take, wr_take, rd_taken_q, wr_taken_q, ref_q;
  logic [1:0]  rd_seen_q, wr_seen_q;  // the counts, as they were at the last edge of clk_ref
  logic [24:0] where_q;
  logic [23:0] wdata_q;
  assign own     = pins_q[24] | pins_q[21] | (pins_q[23:20] == 4'h0);  // on-chip page, AA1, default area
  assign rd_take = own & (rd3_q != rd_seen_q) & (rd2_q == rd3_q) & rd_low2_q;
  assign wr_take = own & (wr3_q != wr_seen_q) & (wr2_q == wr3_q) & wr_low2_q;
  always_ff @(posedge clk_ref_i) begin
    rd_seen_q  <= rd3_q;
    wr_seen_q  <= wr3_q;
    rd_taken_q <= rd_take;
    wr_taken_q <= wr_take;
    where_q    <= pins_q;
    wdata_q    <= pa_wdata_i;
  end
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) ref_q <= 1'b0;
    else         ref_q <= ~ref_q;
  end

  // ---------------------------------------------------------------- clk_pwm: was the strobe still low then?
  logic ref1_q, ref2_q, we_q, rd_q;
  always_ff @(posedge clk_pwm_i) begin
    ref1_q <= ref_q;
    ref2_q <= ref1_q;
  end
  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      we_q <= 1'b0;
      rd_q <= 1'b0;
    end else begin
      // Two edges after one of clk_ref: what the second stage shows are the pins of that edge.
      we_q <= (ref1_q ^ ref2_q) & wr_taken_q & wr_low2_q & (wr2_q == wr_seen_q);
      rd_q <= (ref1_q ^ ref2_q) & rd_taken_q & rd_low2_q & (rd2_q == rd_seen_q);
    end
  end

  assign {int_o, aa_o, x_o, addr_o} = where_q;
  assign wdata_o    = wdata_q;
  assign we_o       = we_q;
  assign rd_o       = rd_q;
  assign rd_falls_o = rd_seen_q;

endmodule : bus_sync

`default_nettype wire
