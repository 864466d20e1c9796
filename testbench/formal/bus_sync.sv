// Rules of the Port A front end, bus_strobes and bus_sync: no strobe of another device is ever taken for one of ours,
// and each of ours is made once, at its own address, with its own data. A step is half a period of clk_pwm, 4.24 ns; an
// edge takes what stood a step before. Each line comes to the board at once or two steps after the CPU has moved it,
// always the same: pads and wires of up to 8.477 ns, of which the ends are the worst. Assumed of the bus, of
// host-bus:2.2 at I52 from 0 to 15, and nothing else of another device's cycle:
// - /RD and /WR are never low together; low and high last a step or more (rows 113, 114: 7.1 ns, 116: 8.5 ns);
// - address, space and AA stand from the fall to a step after the rise (rows 101, 103, 115, 117 and the clock between
//   cycles of few wait states: 5.9 ns); in a write the address from the fall, data from 4 steps behind it, 17.0 ns
//   (host-bus:2.6/6: 15.9), until 15 steps behind it, 63.6 ns (2.6/7: 60.4, and the aperture), and no longer: so R5
//   sees whether they are taken where they stand;
// - a strobe of ours is low for 20 steps or more, 84.8 ns (row 102 with the least wait states of host-bus:2.5: 85.0 at
//   I52 = 3, 91.4 with those of the clock's class; row 116 gives more). One of the 51.9 ns of host-bus:2.6/8 may be
//   made 76.3 ns after its fall, behind its end: R1 fails.
// proof: pdr
// clocks: several
// steps: 70
// fault R1: a strobe that has ended is made nevertheless (rtl/board/bus_sync.sv)
//   - wr_taken_q & wr_low2_q & (wr2_q == wr_seen_q)
//   + wr_taken_q
// fault R2: a strobe of any device is taken (rtl/board/bus_sync.sv)
//   - assign rd_take = own &
//   + assign rd_take =
// fault R3: falls are counted in one bit (rtl/board/bus_strobes.sv)
//   - else         wr_q <= {wr_q[0], ~wr_q[1]};
//   + else         wr_q <= {1'b0, ~wr_q[0]};
// fault R4: /RD is a level, so a short high is missed (rtl/board/bus_strobes.sv)
//   - else         rd_q <= {rd_q[0], ~rd_q[1]};
//   + else         rd_q <= 2'd0;
// fault R5: data are taken with the strobe, before they stand (rtl/board/bus_sync.sv)
//   - wdata_q    <= pa_wdata_i;
//   + if (wr_falls_i != wr1_q) wdata_q <= pa_wdata_i;
// fault R5: a write has the address of the last look at its strobe (rtl/board/bus_sync.sv)
//   - , addr_o} = where_q;
//   + , addr_o} = pins_q;
`default_nettype none

module bus_sync_rules (
  input wire logic rst_ni,
  input wire logic rd_ni,    // as the CPU drives them
  input wire logic wr_ni,
  input wire logic ours_i,   // AA1, else AA0
  input wire logic addr_i,
  input wire logic wdata_i
);

  logic       clk_pwm, clk_ref, edge_pwm;
  proof_clocks clocks (.clk_pwm_o(clk_pwm), .clk_ref_o(clk_ref), .edge_pwm_o(edge_pwm), .edge_ref_o(), .step_o());

  logic [4:0] there;  // the lines at the board
  late_lines #(.Width(5), .Idle(5'b11000)) lines (.now_i({rd_ni, wr_ni, ours_i, addr_i, wdata_i}), .there_o(there),
                                                  .late_o());

  logic [1:0]  rd_falls, wr_falls, rd_of;
  logic [18:0] addr;
  logic [3:0]  aa;
  logic [23:0] wdata;
  logic        x, onchip, we, rd;
  bus_strobes strobes (.rst_ni, .pa_rd_ni(there[4]), .pa_wr_ni(there[3]), .rd_falls_o(rd_falls),
                       .wr_falls_o(wr_falls));
  bus_sync dut (.clk_pwm_i(clk_pwm), .clk_ref_i(clk_ref), .rst_ni, .rd_falls_i(rd_falls), .wr_falls_i(wr_falls),
                .pa_rd_ni(there[4]), .pa_wr_ni(there[3]), .pa_addr_i({18'd0, there[1]}), .pa_x_i(1'b0),
                .pa_aa_i(there[2] ? 4'd2 : 4'd1), .pa_int_i(1'b0), .pa_wdata_i({23'd0, there[0]}),
                .addr_o(addr), .x_o(x), .aa_o(aa), .int_o(onchip), .wdata_o(wdata), .we_o(we), .rd_o(rd),
                .rd_falls_o(rd_of));

  // The bus a step ago, steps since the last edge of a strobe, and the cycle of ours that is under way or was the last.
  logic       started_q = 1'b0, rd_nq = 1'b1, wr_nq = 1'b1, ours_q, addr_q, wdata_q, fall, rise, low;
  logic [4:0] age_q = 5'd31;
  logic [3:0] awake_q = 4'd0;
  assign fall = (rd_nq & ~rd_ni) | (wr_nq & ~wr_ni);
  assign low  = ~rd_nq | ~wr_nq;
  assign rise = low & rd_ni & wr_ni;
  always @($global_clock) begin
    {started_q, rd_nq, wr_nq} <= {1'b1, rd_ni, wr_ni};
    {ours_q, addr_q, wdata_q} <= {ours_i, addr_i, wdata_i};
    age_q   <= (fall || rise) ? 5'd1 : age_q + {4'd0, age_q != 5'd31};
    awake_q <= awake_q + {3'd0, awake_q != 4'd15};
  end
  always_comb begin
    // guarantee: one reset
    assume (rst_ni == started_q);
    // guarantee: power-on
    assume (awake_q == 4'd15 || (rd_ni && wr_ni));
    // guarantee: host-bus:2.5/6, `bus: a, {gate ICs AA1; dual-ported RAM AA2; default area}`
    assume (rd_ni || wr_ni);
    if (low) begin
      // guarantee: host-bus:2.2/113, host-bus:2.2/114,
      //   `bus: {113; 114}, {gate ICs AA1; dual-ported RAM AA2; default area}`
      assume ((rd_nq || wr_ni) && (wr_nq || rd_ni));
      // guarantee: host-bus:2.5/7, `bus: b, {gate ICs AA1; dual-ported RAM AA2; default area}`
      assume (ours_i == ours_q && (!wr_nq || addr_i == addr_q));
      // guarantee: host-bus:2.6/7, `bus: w2, gate ICs AA1`
      assume (wr_nq || age_q >= 5'd15 || addr_i == addr_q);
      // guarantee: host-bus:2.6/6, `bus: w1, gate ICs AA1`; host-bus:2.6/7, `bus: w2, gate ICs AA1`
      assume (wr_nq || age_q >= 5'd15 || age_q <= 5'd4 || wdata_i == wdata_q);
      // guarantee: host-bus:2.6/8, `bus: s1, gate ICs AA1`
      assume (!rise || !ours_q || age_q >= 5'd20);
    end
  end

  // What has come of the cycle: pulses of we and rd, one clk_pwm each, counted with the edge that ends them.
  logic       write_q = 1'b0, read_q = 1'b0, where_q = 1'b0, data_q = 1'b0;
  logic [1:0] writes_q = 2'd0, reads_q = 2'd0;
  always @($global_clock) begin
    if (!wr_nq && age_q <= 5'd4) data_q <= wdata_i;  // until they stand
    if (fall && ours_i) begin
      {write_q, read_q, where_q, data_q} <= {~wr_ni, ~rd_ni, addr_i, wdata_i};
      {writes_q, reads_q}                <= 4'd0;
    end else if (edge_pwm) begin
      if (we && !(&writes_q)) writes_q <= writes_q + 2'd1;
      if (rd && !(&reads_q))  reads_q  <= reads_q + 2'd1;
    end
  end

  always @($global_clock) begin
    if (edge_pwm && we) begin
      // R1: A write is made only while a strobe of ours is low, or was a step before: never of another device's.
      R1: assert (write_q && ours_q && (!wr_nq || age_q <= 5'd2));
      C1: cover (wr_nq == 1'b0);
    end
    if (edge_pwm && rd) begin
      // R2: A read takes its sample only while a strobe of ours is low: never of another device's.
      R2: assert (read_q && ours_q && !rd_nq);
      C2: cover (addr_i);
    end
    if (fall) begin
      // R3: From one cycle of ours to the next a write has been made once, a read has made none.
      if (ours_i) begin
        R3: assert (writes_q == {1'b0, write_q});
        C3: cover (write_q);
      end

      // R4: From one cycle of ours to the next a read has taken one sample, a write none.
      if (ours_i) begin
        R4: assert (reads_q == {1'b0, read_q});
        C4: cover (read_q && !wr_ni);
      end
    end
    if (edge_pwm && (we || rd)) begin
      // R5: Where and with what a write is made, and where a read is, is the address and the data of that cycle.
      R5: assert (aa == 4'd2 && addr[0] == where_q && (!we || wdata[0] == data_q));
      C5: cover (we && wdata[0]);
    end
  end

endmodule : bus_sync_rules

`default_nettype wire
