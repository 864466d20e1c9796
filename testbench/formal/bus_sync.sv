// Rules of the Port A synchroniser with the flip-flops that its strobes turn over (bus_strobes): one strobe a cycle, at
// one edge, with the cycle's own address and data. A step is half a period of clk_ref, 12.7 ns; a pin may change at
// any. An edge of clk_ref that comes with a change takes the old level, one a step later the new one: between them lies
// every phase, and a pin that is taken early or late at random. Assumed of the bus, of host-bus:2.2 with the wait
// states of host-bus:2.5 (least: /WR low 78.7 ns at I52 = 7):
// - /RD and /WR are never low together (host-bus:2.1/2); low for 5 steps or more, the next fall 6 or more after the
//   last (rows 102, 113, 114, 116);
// - address, space and AA stand from the fall to the rise (rows 101, 103, 115, 117), write data from a step after the
//   fall on (rows 108 to 110).
// proof: pdr
// clocks: several
// steps: 16
// fault R1: a fall takes effect at two edges (rtl/board/bus_sync.sv)
//   - wr2_q ^ wr3_q
//   + wr1_q ^ wr3_q
// fault R2: /RD is sampled as a level, so short highs are missed (rtl/board/bus_strobes.sv)
//   - else if (sel_i) rd_q <= ~rd_q;
//   + else if (sel_i) rd_q <= pa_rd_ni;
// fault R4: data are sampled with the strobe, not after it (rtl/board/bus_sync.sv)
//   - wdata_q <= pa_wdata_i;
//   + if (wr_toggle_i != wr1_q) wdata_q <= pa_wdata_i;
`default_nettype none

module bus_sync_rules (
  input wire logic        rst_ni,
  input wire logic        rd_ni,
  input wire logic        wr_ni,
  input wire logic [24:0] where_i,  // int, AA, space, address
  input wire logic [23:0] wdata_i
);

  logic clk_q = 1'b0;
  always @($global_clock) clk_q <= ~clk_q;

  logic        rd_toggle, wr_toggle, we, rd;
  logic [24:0] where;
  logic [23:0] wdata;
  bus_strobes strobes (.rst_ni, .pa_rd_ni(rd_ni), .pa_wr_ni(wr_ni), .sel_i(1'b1),
                       .rd_toggle_o(rd_toggle), .wr_toggle_o(wr_toggle));
  bus_sync dut (.clk_ref_i(clk_q), .rst_ni, .rd_toggle_i(rd_toggle), .wr_toggle_i(wr_toggle),
                .pa_int_i(where_i[24]), .pa_aa_i(where_i[23:20]), .pa_x_i(where_i[19]), .pa_addr_i(where_i[18:0]),
                .pa_wdata_i(wdata_i), .addr_o(where[18:0]), .x_o(where[19]), .aa_o(where[23:20]), .int_o(where[24]),
                .wdata_o(wdata), .we_o(we), .rd_o(rd));

  // The bus a step ago, and the steps since the last fall. No cycle begins before the reset has been gone for a step.
  logic        started_q = 1'b0, awake_q = 1'b0, rd_nq = 1'b1, wr_nq = 1'b1, fall;
  logic [2:0]  age_q = 3'd6;
  logic [24:0] where_q;
  logic [23:0] wdata_q;
  assign fall = (rd_nq & ~rd_ni) | (wr_nq & ~wr_ni);
  always @($global_clock) begin
    {started_q, awake_q, rd_nq, wr_nq} <= {1'b1, started_q, rd_ni, wr_ni};
    age_q   <= fall ? 3'd1 : age_q + {2'd0, age_q != 3'd6};
    where_q <= where_i;
    wdata_q <= wdata_i;
  end
  always_comb begin
    assume (rst_ni == started_q);
    assume (awake_q || (rd_ni && wr_ni));
    assume (rd_ni || wr_ni);
    assume (!fall || age_q == 3'd6);
    if (!rd_nq || !wr_nq) begin
      assume (age_q >= 3'd5 || (rd_ni == rd_nq && wr_ni == wr_nq));
      assume (where_i == where_q);
      assume (wr_nq || age_q < 3'd2 || wdata_i == wdata_q);
    end
  end

  // What a cycle carries, from its pins; the edges of clk_ref and the strobes since its fall. The pins change with an
  // edge after it: an edge comes at the end of each step with clk_q low.
  logic        write_q = 1'b0, read_q = 1'b0;
  logic [1:0]  edges_q = 2'd3, writes_q = 2'd0, reads_q = 2'd0;
  logic [24:0] there_q;
  logic [23:0] carried_q;
  always @($global_clock) begin
    if (fall) begin
      {write_q, read_q} <= {~wr_ni, ~rd_ni};
      there_q           <= where_i;
      edges_q           <= {1'b0, ~clk_q};
      {writes_q, reads_q} <= 4'd0;
    end else if (!clk_q) begin
      if (edges_q != 2'd3)   edges_q  <= edges_q + 2'd1;
      if (we && !(&writes_q)) writes_q <= writes_q + 2'd1;
      if (rd && !(&reads_q))  reads_q  <= reads_q + 2'd1;
    end
    if (age_q == 3'd1) carried_q <= wdata_i;
  end

  always @($global_clock) begin
    if (fall) begin
      // R1: From one fall to the next a write cycle makes one write strobe, a read cycle none.
      R1: assert (writes_q == {1'b0, write_q});
      C1: cover (write_q);

      // R2: From one fall to the next a read cycle makes one read strobe, a write cycle none.
      R2: assert (reads_q == {1'b0, read_q});
      C2: cover (read_q && !rd_ni);
    end
    if (!clk_q) begin
      // R3: A strobe comes at the third edge after the fall, and at no other.
      R3: assert ((we || rd) == (edges_q == 2'd2));
      C3: cover (we || rd);

      // R4: At the edge of a write strobe address and data are those of the cycle.
      if (we) begin
        R4: assert (where == there_q && wdata == carried_q);
        C4: cover (wdata != 24'h0);
      end

      // R5: At the edge of a read strobe the address is that of the cycle.
      if (rd) begin
        R5: assert (where == there_q);
        C5: cover (where != 25'h0);
      end
    end
  end

endmodule : bus_sync_rules

`default_nettype wire
