// Rules of the ISA slave towards the bus and towards what stands behind it, host-bus:3.4, host-bus:3.8, host-bus:3.9. A
// step is half a period of clk_pwm, 4.2 ns; a pin may change at any, and an edge takes what stood a step before it. R1
// to R5, R7 to R10 hold for any pins. R6 is about hosts that have been sound so far: one command at a time, high for 24
// steps between two (host-bus:3.4, row 11: 170 ns) and low for 8 or more, write data standing from 5 steps after the
// fall (row 6) to the rise, no RESETDRV. Switches stand. Of the data two bits are followed, one of each lane.
// proof: pdr
// clocks: several
// steps: 90
// fault R1: SD stays on when the read command goes (rtl/host/isa_slave.sv)
//   - assign isa_sd_oe_o    = lanes_q & {2{drive_q & read_low}};
//   + assign isa_sd_oe_o    = lanes_q & {2{drive_q}};
// fault R2: a second command does not spoil the first (rtl/host/isa_slave.sv)
//   - if (spoilt) target_q <= 4'h0;
//   + ;
// fault R6: write data are those after the command (rtl/host/isa_slave.sv)
//   - if (cmd2_q[Iow] | cmd2_q[Memw]) sd_low_q <= sd2_q;
//   + sd_low_q <= sd2_q;
// fault R5: AEN does not turn I/O off (rtl/host/isa_slave.sv)
//   - assign io_hit  = ~aen_q &
//   + assign io_hit  =
// fault R7: the byte of a read of +4 to +7 is not taken (rtl/host/isa_slave.sv)
//   - assign hp_rd_o      = target_q[Port] & (cycle_q == Start) & kind_q[Ior];
//   + assign hp_rd_o      = target_q[Port] & (cycle_q == Start) & kind_q[Ior] & ~io_addr_q[2];
// fault R8: a write that has ended is made while RESETDRV is seen (rtl/host/isa_slave.sv)
//   - assign takes_effect = finish & ~resetdrv;
//   + assign takes_effect = finish;
// fault R9: a read acknowledges before its data are on the bus (rtl/host/isa_slave.sv)
//   - target_q[Pic] & (cycle_q == Show) & kind_q[Ior] & (cmd2_q == kind_q)
//   + target_q[Pic] & (cycle_q == Start) & kind_q[Ior] & (cmd2_q == kind_q)
// fault R10: IOCHRDY does not wait for the RAM (rtl/host/isa_slave.sv)
//   - iochrdy_q <= ~(((cycle_d == Start) & decoded[Memory]) | mem_busy_d_i);
//   + iochrdy_q <= ~((cycle_d == Start) & decoded[Memory]);
`default_nettype none

module isa_slave_rules (
  input wire logic        rst_ni,
  input wire logic [6:0]  la_i,
  input wire logic [19:0] sa_i,
  input wire logic [15:0] sd_i,
  input wire logic [3:0]  cmd_ni,  // MEMW#, MEMR#, IOW#, IOR#
  input wire logic        aen_i,
  input wire logic        sbhe_ni,
  input wire logic        resetdrv_i,
  input wire logic [7:0]  hp_rdata_i,
  input wire logic [7:0]  pic_rdata_i,
  input wire logic [15:0] mem_rdata_i,
  input wire logic        mem_busy_d_i
);

  logic       clk_pwm, clk_ref, edge_pwm, edge_ref;
  proof_clocks clocks (.clk_pwm_o(clk_pwm), .clk_ref_o(clk_ref), .edge_pwm_o(edge_pwm), .edge_ref_o(edge_ref),
                       .step_o());

  (* anyconst *) logic [7:0] io_base;
  (* anyconst *) logic [9:0] window;
  (* anyconst *) logic       io_decode16, window_flat, slot8;
  (* anyconst *) logic       upper;
  logic [3:0] b;
  assign b = {upper, 3'd0};

  logic [15:0] sd, mem_wdata;
  logic [14:0] mem_addr;
  logic [7:0]  hp_wdata, pic_wdata;
  logic [2:0]  hp_addr;
  logic [1:0]  oe, pic_addr, mem_be;
  logic        ready, cs16_n, host_reset, hp_sel, hp_rd, hp_rd_done, hp_wr, pic_sel, pic_rd, pic_wr;
  logic        mem_sel, mem_rd, mem_wr;
  isa_slave dut (.clk_pwm_i(clk_pwm), .clk_ref_i(clk_ref), .rst_ni, .isa_la_i(la_i), .isa_sa_i(sa_i),
                 .isa_sd_i(sd_i),
                 .isa_ior_ni(cmd_ni[0]), .isa_iow_ni(cmd_ni[1]), .isa_memr_ni(cmd_ni[2]), .isa_memw_ni(cmd_ni[3]),
                 .isa_aen_i(aen_i), .isa_sbhe_ni(sbhe_ni), .isa_resetdrv_i(resetdrv_i), .isa_sd_o(sd), .isa_sd_oe_o(oe),
                 .isa_iochrdy_o(ready), .isa_memcs16_no(cs16_n), .io_base_i(io_base), .io_decode16_i(io_decode16),
                 .window_i(window), .window_flat_i(window_flat), .slot8_i(slot8), .host_reset_o(host_reset),
                 .hp_sel_o(hp_sel), .hp_rd_o(hp_rd), .hp_rd_done_o(hp_rd_done), .hp_wr_o(hp_wr), .hp_addr_o(hp_addr),
                 .hp_wdata_o(hp_wdata), .hp_rdata_i, .pic_sel_o(pic_sel), .pic_rd_o(pic_rd), .pic_wr_o(pic_wr),
                 .pic_addr_o(pic_addr), .pic_wdata_o(pic_wdata), .pic_rdata_i, .mem_sel_o(mem_sel), .mem_rd_o(mem_rd),
                 .mem_wr_o(mem_wr), .mem_addr_o(mem_addr), .mem_be_o(mem_be), .mem_wdata_o(mem_wdata), .mem_rdata_i,
                 .mem_busy_d_i);

  // ---------------------------------------------------------------- the bus as a host drives it
  logic        started_q = 1'b0, sound_q = 1'b1, two, idle, fall, rise;
  logic [3:0]  cmd, cmd_q = 4'h0;
  logic [4:0]  low_q = 5'd0, high_q = 5'd0, two_q = 5'd0;  // steps that a command, none, two have been low
  logic [15:0] sd_q;
  assign cmd  = ~cmd_ni;
  assign two  = (cmd & (cmd - 4'd1)) != 4'd0;
  assign idle = cmd == 4'd0;
  assign fall = cmd_q == 4'd0 && !idle;
  assign rise = cmd_q != 4'd0 && idle;
  always @($global_clock) begin
    started_q <= 1'b1;
    cmd_q     <= cmd;
    sd_q      <= sd_i;
    low_q     <= idle ? 5'd0 : low_q + {4'd0, low_q != 5'd31};
    high_q    <= !idle || !rst_ni ? 5'd0 : high_q + {4'd0, high_q != 5'd31};
    two_q     <= !two ? 5'd0 : two_q + {4'd0, two_q != 5'd31};
    if (two || resetdrv_i || (fall && high_q < 5'd24) || (cmd_q != 4'd0 && (idle ? low_q < 5'd8 : cmd != cmd_q)) ||
        (low_q >= 5'd5 && sd_i != sd_q)) sound_q <= 1'b0;
  end
  // guarantee: one reset
  always_comb assume (rst_ni == started_q);

  // After two commands at once for three edges of clk_pwm and one of clk_ref, until all are high. Of the command that
  // has ended: what may still be written, and the data.
  logic       spoilt_q = 1'b0, data_q;
  logic [1:0] owed_q = 2'd0;  // RAM, I/O
  always @($global_clock) begin
    spoilt_q <= !idle && (spoilt_q || two_q >= 5'd12);
    if (rise) begin
      owed_q <= {cmd_q[3], cmd_q[1]};
      data_q <= sd_q[b];
    end else if (edge_ref && (hp_wr || pic_wr || mem_wr)) begin
      owed_q <= 2'd0;
    end
  end

  // Address, AEN and commands as the edges of clk_ref and clk_pwm take them; the cycle from inside: 1 is its start.
  logic [17:0] at_q = 18'h0, at2_q = 18'h0;
  logic [3:0]  cmd1_q = 4'hF, cmd2_q = 4'hF, begun_q = 4'h0;
  logic        switched_q = 1'b0;
  (* hierconn *) wire logic [2:0] \dut.cycle_q ;
  always @($global_clock) if (rst_ni) begin
    if (edge_ref) {at2_q, at_q, begun_q, switched_q} <= {at_q, aen_i, sa_i[16:0], cmd2_q, 1'b1};
    if (edge_pwm) {cmd2_q, cmd1_q} <= {cmd1_q, cmd};
  end
  logic io_ours;
  assign io_ours = !at2_q[17] && at2_q[9:4] == io_base[5:0] && (!io_decode16 || at2_q[15:10] == {4'h0, io_base[7:6]}) &&
                   (begun_q == 4'd1 || begun_q == 4'd2);

  // The byte of a read of the port was taken, and neither a write nor a reset has come since.
  logic taken_q = 1'b0;
  always @($global_clock) begin
    if (edge_ref) taken_q <= (taken_q | (hp_sel & hp_rd)) & ~hp_rd_done & ~hp_wr & ~host_reset;
  end

  // Data have been on the bus since the last edge of clk_ref.
  logic shown_q = 1'b0;
  always @($global_clock) shown_q <= (shown_q & ~edge_ref) | (oe != 2'b00);

  // What a clk_ref ago was asked of the RAM.
  logic        mem_sel_q = 1'b0, mem_rd_q = 1'b0;
  logic [14:0] mem_addr_q;
  logic [1:0]  mem_be_q;
  always @($global_clock) begin
    if (edge_ref) {mem_sel_q, mem_rd_q, mem_addr_q, mem_be_q} <= {mem_sel, mem_rd, mem_addr, mem_be};
  end

  // What the RAM said at the last edge of clk_ref: BUSY, or not.
  logic busy_q = 1'b0;
  always @($global_clock) if (edge_ref) busy_q <= rst_ni && mem_busy_d_i;

  always @($global_clock) if (rst_ni) begin
    // R1: SD is driven only while a read command is low and no write command is.
    if (oe != 2'b00) begin
      R1: assert ((cmd[0] || cmd[2]) && !cmd[1] && !cmd[3]);
      C1: cover (oe == 2'b11);
    end

    // R2: Two commands at once for 51 ns do nothing and show nothing until all are high.
    if (spoilt_q) begin
      R2: assert (oe == 2'b00 && !hp_rd && !hp_wr && !hp_rd_done && !pic_rd && !pic_wr && !mem_wr && !mem_sel);
      C2: cover (!two);
    end

    // R3: The RAM is told one access at a time: address, lanes and direction stand from its start to the clock after
    // its end, and only there and only of a write is it written.
    if (edge_ref && mem_sel_q) begin
      R3: assert ({mem_addr, mem_be, mem_rd} == {mem_addr_q, mem_be_q, mem_rd_q} && !(mem_wr && (mem_sel || mem_rd)));
      C3: cover (mem_wr);
    end

    // R4: No strobe comes but after the command that it is of: the RAM's after an access, one of all at a time.
    if (edge_ref) begin
      R4: assert ((!mem_wr || mem_sel_q) && {2'd0, hp_wr} + {2'd0, hp_rd_done} + {2'd0, hp_rd} + {2'd0, pic_wr} +
                  {2'd0, pic_rd} + {2'd0, mem_wr} <= 3'd1);
      C4: cover (hp_rd_done);
    end

    // R5: A cycle is for the port or the interrupt controller if SA and AEN, as sampled at the start of one command
    // alone, name their bytes, and for the RAM only if SA names the window.
    if (switched_q && \dut.cycle_q == 3'd1) begin
      R5: assert (hp_sel == (io_ours && !at2_q[3]) && pic_sel == (io_ours && at2_q[3:2] == 2'b10) &&
                  (!mem_sel || ((begun_q == 4'd4 || begun_q == 4'd8) && at2_q[16] == window[2] &&
                                (window_flat || at2_q[15:14] == window[1:0]))));
      C5: cover (hp_sel);
    end

    // R6: What is written is of a write command that has ended, of I/O or of memory, once, with its data.
    if (sound_q && edge_ref && (hp_wr || pic_wr || mem_wr)) begin
      R6: assert ((mem_wr ? owed_q[1] : owed_q[0]) && (!hp_wr || upper || hp_wdata[0] == data_q) &&
                  (!pic_wr || upper || pic_wdata[0] == data_q) &&
                  (!mem_wr || mem_be == 2'b10 || mem_wdata[b] == data_q));
      C6: cover (mem_wr && data_q);
    end

    // R7: The end of a read of the port comes after the edge that took its byte, with no write and no reset between.
    if (edge_ref && hp_rd_done) begin
      R7: assert (taken_q);
      C7: cover (hp_addr == 3'd7);
    end

    // R8: While RESETDRV is seen no cycle writes, ends a read of the port, or acknowledges.
    if (edge_ref && host_reset) begin
      R8: assert (!hp_wr && !hp_rd_done && !pic_wr && !pic_rd && !mem_wr);
      C8: cover (pic_sel);
    end

    // R9: A read acknowledges only when its data have been on the bus.
    if (edge_ref && pic_rd) begin
      R9: assert (shown_q);
      C9: cover (oe == 2'b00);
    end

    // R10: IOCHRDY is low in the first clock of an access to the RAM and while that is BUSY, and never else.
    R10: assert (ready == !((mem_sel && \dut.cycle_q == 3'd1) || busy_q));
    C10: cover (busy_q && mem_sel && \dut.cycle_q == 3'd2);
  end

endmodule : isa_slave_rules

`default_nettype wire
