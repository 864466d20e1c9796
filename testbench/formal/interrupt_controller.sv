// Rules of the interrupt controller, host-bus:4.1, with the line to the host, host-bus:3.5, for each of its eight lines
// (`n` is any) and whatever lines, writes and resets do: no event is lost, none comes twice, and a host that senses the
// edges of IRQ has one for each. Nothing is assumed but that a run starts in reset.
// proof: pdr
// clocks: one
// steps: 12
// fault R4: a clear wins over a rise that meets it (rtl/host/interrupt_controller.sv)
//   - (rise & msk_q & ~elr_q) | (latch_q & msk_q & ~{8{clear}})
//   + ((rise & msk_q & ~elr_q) | (latch_q & msk_q)) & ~{8{clear}}
// fault R6: the end of a high level counts as a second rise (rtl/host/interrupt_controller.sv)
//   - line2_q & ~line3_q
//   + line2_q & ~(line3_q & line_i)
// fault R8: an edge is remembered while its line is masked (rtl/host/interrupt_controller.sv)
//   - (rise & msk_q & ~elr_q)
//   + (rise & ~elr_q)
// fault R14: a clear leaves IRQ high while requests remain (rtl/host/host_interrupt.sv)
//   - request_i & ~served_i & (low_q == 3'd0)
//   + request_i & (low_q == 3'd0)
// fault R13: IRQ is low for a clock less (rtl/host/host_interrupt.sv)
//   - IrqLowClocks - 3'd1
//   + IrqLowClocks - 3'd2
// fault R15: a latched edge asks for one clock only (rtl/host/interrupt_controller.sv)
//   - (~elr_d & latch_d)
//   + (~elr_d & rise)
`default_nettype none

module interrupt_controller_rules (
  input wire logic       clk_i,
  input wire logic       rst_ni,
  input wire logic       reset_i,  // RESETDRV
  input wire logic [7:0] line_i,
  input wire logic       wr_i,
  input wire logic [1:0] addr_i,
  input wire logic [7:0] wdata_i
);

  logic [7:0] rdata, ist, sig, msk, elr;
  logic       request, served, irq;
  interrupt_controller dut (.clk_ref_i(clk_i), .rst_ni, .reset_i, .line_i, .wr_i, .addr_i, .wdata_i,
                            .rdata_o(rdata), .ist_o(ist), .sig_o(sig), .msk_o(msk), .elr_o(elr),
                            .request_o(request), .served_o(served));
  host_interrupt line (.clk_ref_i(clk_i), .rst_ni, .request_i(request), .served_i(served), .irq_o(irq));

  (* anyconst *) logic [2:0] n;
  logic clear, high, enabled, edges, pending, rise;
  assign clear   = wr_i & (addr_i == 2'd0);
  assign high    = sig[n];
  assign enabled = msk[n];
  assign edges   = ~elr[n];
  assign pending = ist[n];
  assign rise    = high & ~high_q;

  // What an observer of the pins remembers. `pin_q[k]` is the line k + 1 clocks ago.
  logic       started_q = 1'b0;
  logic       high_q, edges_q, event_q, served_q, blind_q;
  logic [3:0] pin_q;
  logic [2:0] low_q, stands_q;  // clocks that IRQ has been low; that n is pending, since a clear or another mode
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {high_q, edges_q, event_q, served_q, blind_q} <= 5'b00001;
      pin_q    <= 4'h0;
      low_q    <= 3'd4;
      stands_q <= 3'd0;
    end else begin
      high_q   <= high;
      edges_q  <= edges;
      event_q  <= (event_q | (pending & edges)) & enabled & ~clear & ~reset_i;
      served_q <= (served_q | clear) & ~rise;
      blind_q  <= ~enabled | (blind_q & ~(rise & edges));
      pin_q    <= {pin_q[2:0], line_i[n]};
      low_q    <= irq ? 3'd0 : low_q + {2'd0, low_q != 3'd4};
      stands_q <= (clear || !pending || edges != edges_q) ? 3'd0 : stands_q + {2'd0, stands_q != 3'd4};
    end
  end

  always @(posedge clk_i) begin
    started_q <= 1'b1;
    // guarantee: power-on
    assume (started_q || !rst_ni);
    if (started_q && rst_ni && $past(rst_ni)) begin
      // R1: SIG is the line two clocks ago, whatever mask, mode and writes.
      R1: assert (high == pin_q[1]);
      C1: cover (high && !enabled);

      // R2: IST shows no line that is masked.
      R2: assert (enabled || !pending);
      C2: cover (!enabled && rise);

      // R3: An enabled edge line that was low and is high raises IRQ at the third clock, if that may rise.
      if (pin_q[2] && !pin_q[3] && enabled && edges && $past(enabled && edges)) begin
        R3: assert (pending && (irq || $past(clear) || low_q != 3'd4));
        C3: cover (!$past(irq));
      end

      // R4: A rise of an enabled edge line is pending a clock later, even if a clear meets it.
      if ($past(rise && enabled && edges && !reset_i) && enabled && edges) begin
        R4: assert (pending);
        C4: cover ($past(clear));
      end

      // R5: What is pending stays until a clear or its mask takes it, through level mode and back too.
      if (event_q && enabled && edges) begin
        R5: assert (pending);
        C5: cover ($past(!edges));
      end

      // R6: An edge line becomes pending by a rise alone.
      if ($past(enabled && edges && !pending) && edges && pending) begin
        R6: assert ($past(rise));
        C6: cover (1'b1);
      end

      // R7: After a clear an edge line must fall and rise before it is pending again.
      if (served_q && edges) begin
        R7: assert (!pending);
        C7: cover (high && enabled);
      end

      // R8: An edge while masked is not remembered.
      if (blind_q && edges) begin
        R8: assert (!pending);
        C8: cover (high && enabled && !$past(high, 2) && $past(high));
      end

      // R9: In level mode an enabled line is pending while it is high.
      if (!edges) begin
        R9: assert (pending == (enabled && high));
        C9: cover (pending && $past(clear));
      end

      // R10: IRQ is high only by a bit of IST, or by a level line that was high a clock ago.
      if (irq) begin
        R10: assert (ist != 8'h00 || (msk & elr & $past(sig)) != 8'h00);
        C10: cover (!pending);
      end

      // R11: The four addresses read IST, SIG, MSK and ELR.
      R11: assert (rdata == (addr_i[1] ? (addr_i[0] ? elr : msk) : (addr_i[0] ? sig : ist)));
      C11: cover (addr_i == 2'd0 && rdata != 8'h00 && rdata != sig && rdata != msk);

      // R12: MSK and ELR change by a write to them alone, and are 0 after RESETDRV.
      R12: assert ($past(reset_i) ? (msk | elr) == 8'h00 :
                   msk == ($past(wr_i && addr_i == 2'd2) ? $past(wdata_i) : $past(msk)) &&
                   elr == ($past(wr_i && addr_i == 2'd3) ? $past(wdata_i) : $past(elr)));
      C12: cover (msk != elr && msk != 8'h00 && elr != 8'h00);

      // R13: IRQ is never low for less than four clocks.
      if (irq && !$past(irq)) begin
        R13: assert (low_q == 3'd4);
        C13: cover ($past(clear, 5) && $past(irq, 5));
      end

      // R14: A clear pulls IRQ down, so that whatever is pending after it has an edge to come.
      if ($past(clear)) begin
        R14: assert (!irq);
        C14: cover (pending && $past(irq));
      end

      // R15: What has been pending for four clocks since the last clear has raised IRQ, unless its mode was changed.
      if (stands_q == 3'd4 && pending && edges == edges_q) begin
        R15: assert (irq);
        C15: cover ($past(clear, 5) && edges);
      end
    end
  end

endmodule : interrupt_controller_rules

`default_nettype wire
