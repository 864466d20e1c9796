// Rules of the host port, host-bus:3.2, about words: between a host and a CPU that look at their flags, each word comes
// out once, in order and unchanged. Assumed: each side makes one access at a time (a bus has one cycle at a time,
// host-bus:2.1/2), and fills or empties a register only after its flag told it so since the last time (host-bus:3.1/5,
// host-bus:3.1/6), whenever it looked; an INIT or RESETDRV is such news to the CPU too. The host may read +7 blindly: a
// word counts as taken if RXDF was 1 when the byte was. Everything else is free.
// proof: pdr
// clocks: one
// steps: 14
// fault R1: a word moves on although the last one still waits (rtl/host/host_port.sv)
//   - assign tx_move = ~txde_q & ~hrdf_q;
//   + assign tx_move = ~txde_q;
// fault R3: a word that moves while the CPU looks at the port is lost (rtl/host/host_port.sv)
//   - hrdf_d = tx_move | (hrdf_q & ~horx_read);
//   + hrdf_d = (tx_move & ~dsp_sel_i) | (hrdf_q & ~horx_read);
// fault R6: the word stays in RX after it was read (rtl/host/host_port.sv)
//   - rxdf_d = rx_move | (rxdf_q & ~(data7_read & saw_q));
//   + rxdf_d = rx_move | (rxdf_q & ~(data7_read & saw_q & htde_q));
// fault R7: a read that found RX empty frees the word that came meanwhile (rtl/host/host_port.sv)
//   - rxdf_d = rx_move | (rxdf_q & ~(data7_read & saw_q));
//   + rxdf_d = rx_move | (rxdf_q & ~data7_read);
`default_nettype none

// Words of one way between their writer and their reader: how many, and one of them, followed from end to end.
module word_ledger (
  input wire logic        clk_i,
  input wire logic        rst_ni,
  input wire logic        empty_i,    // INIT: all are gone
  input wire logic        put_i,
  input wire logic [23:0] word_i,
  input wire logic        take_i,
  input wire logic        follow_i,   // this word, if none is followed
  output logic [1:0]      count_o,
  output logic            settled_o,  // nothing came or went for two clocks
  output logic            first_o,    // the followed word is the next to be taken
  output logic [23:0]     word_o
);
  logic [1:0]  count_q, age_q, ahead_q;
  logic        follow_q;
  logic [23:0] word_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {count_q, age_q, ahead_q, follow_q} <= 7'd0;
      word_q <= 24'd0;
    end else begin
      age_q   <= (empty_i | put_i | take_i) ? 2'd0 : age_q + {1'b0, age_q < 2'd2};
      count_q <= empty_i ? 2'd0 : count_q + {1'b0, put_i} - {1'b0, take_i};
      if (empty_i) begin
        follow_q <= 1'b0;
      end else if (follow_q) begin
        if (take_i) {follow_q, ahead_q} <= {ahead_q != 2'd0, ahead_q - 2'd1};
      end else if (put_i && follow_i) begin
        follow_q <= 1'b1;
        ahead_q  <= count_q - {1'b0, take_i};
        word_q   <= word_i;
      end
    end
  end
  assign count_o   = count_q;
  assign settled_o = age_q == 2'd2;
  assign first_o   = follow_q & (ahead_q == 2'd0);
  assign word_o    = word_q;
endmodule : word_ledger

module host_port_rules (
  input wire logic        clk_i,
  input wire logic        rst_ni,
  input wire logic        sel_i,
  input wire logic        rd_i,     // a read takes its byte
  input wire logic        rd_done_i,
  input wire logic        wr_i,
  input wire logic [2:0]  addr_i,
  input wire logic [7:0]  wdata_i,
  input wire logic        reset_i,  // RESETDRV
  input wire logic        cpu_sel_i,
  input wire logic        cpu_we_i,
  input wire logic        cpu_rd_i,  // a read takes its sample
  input wire logic [5:0]  cpu_addr_i,
  input wire logic [23:0] cpu_wdata_i,
  input wire logic [1:0]  follow_i
);

  localparam logic [2:0] Icr = 3'd0, Cvr = 3'd1, Isr = 3'd2;
  localparam logic [5:0] Hcr = 6'h02, Hsr = 6'h03, Horx = 6'h06, Hotx = 6'h07;

  logic [7:0]  rdata;
  logic [23:0] cpu_rdata;
  logic        hreq, irq, txde, rxdf;
  host_port dut (.clk_ref_i(clk_i), .rst_ni, .hp_sel_i(sel_i), .hp_rd_i(rd_i), .hp_rd_done_i(rd_done_i),
                 .hp_wr_i(wr_i), .hp_addr_i(addr_i), .hp_wdata_i(wdata_i), .hp_rdata_o(rdata), .hp_reset_i(reset_i),
                 .dsp_sel_i(cpu_sel_i), .dsp_we_i(cpu_we_i), .dsp_rd_i(cpu_rd_i), .dsp_addr_i(cpu_addr_i),
                 .dsp_wdata_i(cpu_wdata_i), .dsp_rdata_o(cpu_rdata), .hreq_o(hreq), .irq_o(irq), .txde_o(txde),
                 .rxdf_o(rxdf));

  // What both sides do and see at the pins.
  logic host_wr, cpu_wr, data, send, fetch, cpu_send, cpu_fetch, init, init_tx, init_rx, isr, hsr;
  assign host_wr   = sel_i & wr_i;
  assign cpu_wr    = cpu_sel_i & cpu_we_i;
  assign data      = (addr_i == 3'd5) | (addr_i == 3'd6) | (addr_i == 3'd7);
  assign send      = host_wr & (addr_i == 3'd7);
  assign fetch     = sel_i & rd_done_i & (addr_i == 3'd7);
  assign cpu_send  = cpu_wr & (cpu_addr_i == Hotx);
  assign cpu_fetch = cpu_sel_i & cpu_rd_i & (cpu_addr_i == Horx);
  assign init      = host_wr & (addr_i == Icr) & wdata_i[7];
  assign init_tx   = (init & wdata_i[1]) | reset_i;
  assign init_rx   = (init & wdata_i[0]) | reset_i;
  assign isr       = sel_i & (addr_i == Isr);
  assign hsr       = cpu_sel_i & (cpu_addr_i == Hsr);

  // What each side knows: the flags seen since it last acted on them, and the registers that it wrote.
  logic        started_q = 1'b0;
  logic        read_q, full_q;  // the byte of a read was taken, and there was a word
  logic        may_send_q, may_fetch_q, cpu_may_send_q, cpu_may_fetch_q, command_q;
  logic [7:0]  icr_q;
  logic [2:0]  enable_q;
  logic [23:0] word, word_q;  // what the host has put together in TX
  always_comb begin
    word = word_q;
    if (host_wr && addr_i == 3'd6)                    word[15:8]  = wdata_i;
    if (host_wr && addr_i == {1'b1, ~icr_q[5], 1'b1}) word[7:0]   = wdata_i;
    if (host_wr && addr_i == {1'b1, icr_q[5], 1'b1})  word[23:16] = wdata_i;
  end
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {read_q, full_q, may_send_q, may_fetch_q, cpu_may_send_q, cpu_may_fetch_q, command_q} <= 7'd0;
      icr_q    <= 8'h00;
      enable_q <= 3'd0;
      word_q   <= 24'h0;
    end else begin
      read_q          <= ((sel_i & rd_i) | read_q) & ~fetch & ~init_rx;
      if (sel_i & rd_i) full_q <= rxdf;
      may_send_q      <= (may_send_q | (isr & rdata[1])) & ~send;
      may_fetch_q     <= (may_fetch_q | (isr & rdata[0])) & ~fetch & ~init_rx;
      cpu_may_send_q  <= (cpu_may_send_q | (hsr & cpu_rdata[1])) & ~cpu_send;
      cpu_may_fetch_q <= (cpu_may_fetch_q | (hsr & cpu_rdata[0])) & ~cpu_fetch & ~init_tx;
      if (reset_i)                                            command_q <= 1'b0;
      else if (host_wr && addr_i == Cvr)                      command_q <= wdata_i[7];
      else if (cpu_wr && cpu_addr_i == Hsr && cpu_wdata_i[2]) command_q <= 1'b0;
      if (reset_i)                          icr_q    <= 8'h00;
      else if (host_wr && addr_i == Icr)    icr_q    <= wdata_i;
      if (cpu_wr && cpu_addr_i == Hcr)      enable_q <= cpu_wdata_i[2:0];
      word_q <= word;
    end
  end
  always @(posedge clk_i) begin
    started_q <= 1'b1;
    // guarantee: power-on
    assume (started_q || !rst_ni);
    // guarantee: isa_slave R4; bus_sync R3, R4
    assume (!(wr_i && rd_done_i) && !(cpu_we_i && cpu_rd_i));
    // guarantee: host-bus:3.9/3, `bus: room-in-tx, I/O`
    assume (!(host_wr && data) || may_send_q);
    // guarantee: isa_slave R4
    assume (!rd_i || !(wr_i || rd_done_i));
    // guarantee: isa_slave R7
    assume (!fetch || read_q);
    // guarantee: host-bus:3.2/12, `breq-rotary: by interrupts, I16=5 I17=10, lines`
    assume (!cpu_send || cpu_may_send_q);
    assume (!cpu_fetch || cpu_may_fetch_q);
  end

  logic [1:0]  count, cpu_count;
  logic        settled, cpu_settled, first, cpu_first;
  logic [23:0] followed, cpu_followed;
  word_ledger to_cpu (.clk_i, .rst_ni, .empty_i(init_tx), .put_i(send), .word_i(word), .take_i(cpu_fetch),
                      .follow_i(follow_i[0]), .count_o(count), .settled_o(settled), .first_o(first),
                      .word_o(followed));
  word_ledger to_host (.clk_i, .rst_ni, .empty_i(init_rx), .put_i(cpu_send), .word_i(cpu_wdata_i),
                       .take_i(fetch & full_q), .follow_i(follow_i[1]), .count_o(cpu_count),
                       .settled_o(cpu_settled), .first_o(cpu_first), .word_o(cpu_followed));

  always @(posedge clk_i) if (rst_ni) begin
    // R1: The CPU reads each word of the host in its turn and unchanged.
    if (cpu_fetch && first) begin
      R1: assert (cpu_rdata == followed);
      C1: cover (count == 2'd2 && followed == 24'h123456);
    end

    // R2: HRDF shows a word only while one is on the way: none comes twice.
    if (hsr) begin
      R2: assert (!cpu_rdata[0] || count != 2'd0);
      C2: cover (cpu_rdata[0]);
    end

    // R3: A word on the way shows in HRDF two clocks after the last one came or went: none is lost.
    if (hsr && settled && count != 2'd0) begin
      R3: assert (cpu_rdata[0]);
      C3: cover (count == 2'd2);
    end

    // R4: TXDE lets a second word in behind the first, and no third.
    if (isr) begin
      R4: assert (rdata[1] ? count <= 2'd1 : (count == 2'd2 || !settled));
      C4: cover (rdata[1] && count == 2'd1);
    end

    // R5: The host reads each word of the CPU in its turn and unchanged, byte by byte as HLEND says.
    if (sel_i && may_fetch_q && cpu_first && data) begin
      R5: assert (rdata == (addr_i == 3'd6 ? cpu_followed[15:8] :
                            addr_i[1] == icr_q[5] ? cpu_followed[23:16] : cpu_followed[7:0]));
      C5: cover (fetch && cpu_count == 2'd2 && icr_q[5]);
    end

    // R6: RXDF shows a word only while one is on the way: none comes twice.
    if (isr) begin
      R6: assert (!rdata[0] || cpu_count != 2'd0);
      C6: cover (rdata[0]);
    end

    // R7: A word on the way shows in RXDF two clocks after the last one came or went: none is lost.
    if (isr && cpu_settled && cpu_count != 2'd0) begin
      R7: assert (rdata[0]);
      C7: cover (cpu_count == 2'd2);
    end

    // R8: HTDE lets a second word in behind the first, and no third.
    if (hsr) begin
      R8: assert (cpu_rdata[1] ? cpu_count <= 2'd1 : (cpu_count == 2'd2 || !cpu_settled));
      C8: cover (cpu_rdata[1] && cpu_count == 2'd1);
    end

    // R9: HREQ is (RREQ and RXDF) or (TREQ and TXDE); the pins of the two flags agree with ISR.
    if (isr) begin
      R9: assert (hreq == ((icr_q[0] && rdata[0]) || (icr_q[1] && rdata[1])) && rdata[1:0] == {txde, rxdf});
      C9: cover (hreq && !icr_q[1]);
    end

    // R10: The CPU's interrupt is (HRIE and HRDF) or (HTIE and HTDE) or (HCIE and HCP).
    if (hsr) begin
      R10: assert (irq == ((enable_q & cpu_rdata[2:0]) != 3'd0));
      C10: cover (irq && enable_q == 3'b100);
    end

    // R11: A host command pends until the CPU takes it; one that is written at that moment pends.
    if (hsr) begin
      R11: assert (cpu_rdata[2] == command_q);
      C11: cover (command_q && $past(cpu_wr && cpu_addr_i == Hsr && cpu_wdata_i[2]));
    end
  end

endmodule : host_port_rules

`default_nettype wire
