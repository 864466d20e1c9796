// Rules of the 8259, host-bus:4.5, whatever lines, reads and writes do, in all its modes: what is masked does not
// interrupt, what interrupts is above all in service, a request is acknowledged once, and an end ends what it should.
// `n` is any level; a rank is the distance from the level of the highest priority. Assumed is only that a run starts in
// reset and that isa_slave does not read and write at one clock.
// proof: pdr
// clocks: one
// steps: 14
// fault R1: the mask holds nothing off (rtl/host/pic_8259.sv)
//   - rank(irr & ~imr_q, lowest_q)
//   + rank(irr, lowest_q)
// fault R2: a request interrupts the service of its own level (rtl/host/pic_8259.sv)
//   - (rank_request < rank_serviced)
//   + (rank_request <= rank_serviced) & ~rank_request[3]
// fault R4: an acknowledged line need not fall (rtl/host/pic_8259.sv)
//   - armed_d = armed_w & ~(8'd1 << level_ack)
//   + armed_d = armed_w | (8'd1 << level_ack)
// fault R5: a spurious acknowledge puts IR7 in service (rtl/host/pic_8259.sv)
//   - pending & (rd_poll | (rd_i & (addr_i == Acknowledge)))
//   + rd_poll | (rd_i & (addr_i == 2'd2))
// fault R6: an end without a level ends the one that asks (rtl/host/pic_8259.sv)
//   - wdata_i[brick_regs_pkg::Pic8259Ocw2IrLsb +: 3] : level_serviced
//   + wdata_i[2:0] : level_request
// fault R8: an automatic end leaves its level in service (rtl/host/pic_8259.sv)
//   - if (!aeoi_q) isr_d
//   + if (1'b1) isr_d
// fault R9: INT is asked for by what the registers were before the edge (rtl/host/pic_8259.sv)
//   - assign request_o = (step_d == StepReady) & (rank(asks, lowest_w) < rank(holds, lowest_w));
//   + assign request_o = pending;
// fault R10: a line that is high at the reset has an edge (rtl/host/pic_8259.sv)
//   - sync2 #(.Width(8), .Reset(8'hFF)) u_line_sync
//   + sync2 #(.Width(8)) u_line_sync
`default_nettype none

module pic_8259_rules (
  input wire logic       clk_i,
  input wire logic       rst_ni,
  input wire logic [7:0] line_i,
  input wire logic       rd_i,
  input wire logic       wr_i,
  input wire logic [1:0] addr_i,
  input wire logic [7:0] wdata_i
);

  logic [7:0] rdata, irr, isr, imr;
  logic       level, request, served;
  pic_8259 dut (.clk_ref_i(clk_i), .rst_ni, .line_i, .rd_i, .wr_i, .addr_i, .wdata_i, .rdata_o(rdata), .irr_o(irr),
                .isr_o(isr), .imr_o(imr), .level_o(level), .request_o(request), .served_o(served));
  // From inside: the modes that the words have set.
  (* hierconn *) wire logic [2:0] \dut.lowest_q ;
  (* hierconn *) wire logic       \dut.special_q ;
  (* hierconn *) wire logic       \dut.aeoi_q ;
  (* hierconn *) wire logic       \dut.poll_q ;
  (* hierconn *) wire logic       \dut.pending ;
  (* hierconn *) wire logic [1:0] \dut.step_q ;

  (* anyconst *) logic [2:0] n;
  logic [2:0] acked, rank_acked, rank_n;
  logic       icw1, ocw2, end_plain, holds, acknowledge;
  assign acked       = rdata[2:0];  // what the host reads in an acknowledge
  assign rank_acked  = acked - \dut.lowest_q - 3'd1;
  assign rank_n      = n - \dut.lowest_q - 3'd1;
  assign icw1        = wr_i & (addr_i == 2'd0) & wdata_i[4];
  assign ocw2        = wr_i & (addr_i == 2'd0) & (wdata_i[4:3] == 2'b00);
  assign end_plain   = ocw2 & (wdata_i[6:5] == 2'b01);
  assign acknowledge = rd_i & ((addr_i == 2'd2) | (\dut.poll_q & ~addr_i[1]));
  assign holds       = isr[n] & ~(\dut.special_q & imr[n]);  // n holds off others

  // What an observer of the pins remembers. `pin_q[k]` is line n k + 1 clocks ago.
  logic       started_q = 1'b0, once_q, low_q, above, above_n;
  logic [1:0] pin_q;
  logic [2:0] lowest_q;
  logic [7:0] isr_q, asking;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      once_q <= 1'b0;
      low_q  <= 1'b0;
      pin_q  <= 2'b00;
    end else begin
      once_q <= ((once_q & ~icw1) | (served & (acked == n))) & pin_q[1];
      low_q  <= low_q | ~line_i[n];
      pin_q  <= {pin_q[0], line_i[n]};
    end
  end

  // Whether the level that an end has taken out of service was above n.
  always_ff @(posedge clk_i) {isr_q, lowest_q} <= {isr, \dut.lowest_q };
  always_comb begin
    above = 1'b0;
    for (int unsigned k = 0; k < 8; k++) begin
      if (isr_q[k] && !isr[k]) above = (k[2:0] - lowest_q - 3'd1) < (n - lowest_q - 3'd1);
    end
  end

  // What asked for INT at the last edge: a line that fell at it still did. Whether one of them is above n.
  logic [7:0] irr_q;
  logic       request_q;
  always_ff @(posedge clk_i) {irr_q, request_q} <= {irr, request & ~served};
  assign asking = irr_q & ~imr;
  always_comb begin
    above_n = 1'b0;
    for (int unsigned k = 0; k < 8; k++) begin
      if (asking[k] && (k[2:0] - \dut.lowest_q - 3'd1) < rank_n) above_n = 1'b1;
    end
  end

  always @(posedge clk_i) begin
    started_q <= 1'b1;
    // guarantee: power-on
    assume (started_q || !rst_ni);
    // guarantee: isa_slave R4
    assume (!rd_i || !wr_i);
    if (started_q && rst_ni && $past(rst_ni)) begin
      // R1: What is acknowledged asks and is not masked.
      if (served) begin
        R1: assert (irr[acked] && !imr[acked]);
        C1: cover ((irr & imr) != 8'h00);
      end

      // R2: What is acknowledged is above every level that holds off others.
      if (served && holds) begin
        R2: assert (rank_acked < rank_n);
        C2: cover (\dut.lowest_q != 3'd7);
      end

      // R3: What is acknowledged is the highest of all that ask and are not masked.
      if (served && irr[n] && !imr[n]) begin
        R3: assert (rank_acked <= rank_n);
        C3: cover (acked != n);
      end

      // R4: By edge a line that was acknowledged does not ask again before it has been low.
      if (once_q && !level) begin
        R4: assert (!irr[n]);
        C4: cover (pin_q[0] && pin_q[1]);
      end

      // R5: An acknowledge without a request gives IR7 and changes nothing in service.
      if ($past(acknowledge && !\dut.pending )) begin
        R5: assert ($past(rdata[2:0]) == 3'd7 && isr == $past(isr));
        C5: cover ($past(imr) != 8'hFF);
      end

      // R6: An end without a level ends the highest that holds off others, and it alone, or nothing if none does.
      if ($past(end_plain)) begin
        R6: assert ((isr & ~isr_q) == 8'h00 && ((isr_q & ~isr) & ((isr_q & ~isr) - 8'd1)) == 8'h00 &&
                    (!$past(holds) || (isr != isr_q && (!isr[n] || above))));
        C6: cover ($past(holds) && isr[n]);
      end

      // R7: In service comes a level by its acknowledge alone, and goes by an end or ICW1 alone.
      R7: assert (isr[n] ? $past(isr[n] || (served && acked == n)) : $past(!isr[n] || icw1 || (ocw2 && wdata_i[5])));
      C7: cover (isr[n] && !$past(isr[n]));

      // R8: With automatic ends nothing comes into service.
      if ($past(served && \dut.aeoi_q )) begin
        R8: assert ((isr & ~$past(isr)) == 8'h00);
        C8: cover ($past(irr) != irr);
      end

      // R9: INT is asked for only by a level that after the edge is not masked, and then is above every level in
      // service, and not in the initialization.
      if (request_q) begin
        R9: assert (asking != 8'h00 && (!holds || above_n) && \dut.step_q == 2'd0);
        C9: cover (holds && $past(wr_i));
      end

      // R10: By edge no line asks that has not been low since the reset.
      if (!low_q && !level) begin
        R10: assert (!irr[n]);
        C10: cover (pin_q == 2'b11 && !imr[n]);
      end
    end
  end

endmodule : pic_8259_rules

`default_nettype wire
