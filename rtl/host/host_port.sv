// Host port (HI08): eight bytes for the host, six words for the CPU, one word of buffering on either side of each way.
//   host +5,+6,+7 -> TX -> HORX -> CPU     a word moves when TXDE = 0 and HRDF = 0
//   CPU -> HOTX -> RX -> host +5,+6,+7     a word moves when HTDE = 0 and RXDF = 0
// Byte +7 is the one that launches TX and frees RX. A move takes one clock and sets full and empty flags together. HPCR
// and HBAR are stored and read back: the board wires the port for good. HSR shows the host's command number in bits
// 14..8 and takes the command when bit 2 is written 1, because the CPU has no vector fetch of its own. Clock clk_ref_i,
// asynchronous reset. docs/host_port.md.
`default_nettype none

module host_port (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  // host side
  input  wire logic        hp_sel_i,
  input  wire logic        hp_rd_i,        // one clk_ref, at the edge that takes hp_rdata_o
  input  wire logic        hp_rd_done_i,   // one clk_ref at the end of a read
  input  wire logic        hp_wr_i,        // one clk_ref
  input  wire logic [2:0]  hp_addr_i,
  input  wire logic [7:0]  hp_wdata_i,
  output logic [7:0]       hp_rdata_o,
  input  wire logic        hp_reset_i,     // RESETDRV: empties both ways, the host's registers as after a reset
  // CPU side
  input  wire logic        dsp_sel_i,
  input  wire logic        dsp_we_i,       // one clk_ref
  input  wire logic        dsp_rd_i,       // one clk_ref, at which a read takes its sample
  input  wire logic [5:0]  dsp_addr_i,     // low six bits of X:$FFFFxx
  input  wire logic [23:0] dsp_wdata_i,
  output logic [23:0]      dsp_rdata_o,
  output logic             hreq_o,
  output logic             irq_o,
  output logic             txde_o,
  output logic             rxdf_o
);

  localparam logic [2:0] Icr   = brick_regs_pkg::HostIoIcrAddr[2:0];
  localparam logic [2:0] Cvr   = brick_regs_pkg::HostIoCvrAddr[2:0];
  localparam logic [2:0] Isr   = brick_regs_pkg::HostIoIsrAddr[2:0];
  localparam logic [2:0] Ivr   = brick_regs_pkg::HostIoIvrAddr[2:0];
  localparam logic [2:0] Data5 = brick_regs_pkg::HostIoData5Addr[2:0];
  localparam logic [2:0] Data6 = brick_regs_pkg::HostIoData6Addr[2:0];
  localparam logic [2:0] Data7 = brick_regs_pkg::HostIoData7Addr[2:0];
  localparam logic [5:0] Hcr   = brick_regs_pkg::Hi08HcrAddr[5:0];
  localparam logic [5:0] Hsr   = brick_regs_pkg::Hi08HsrAddr[5:0];
  localparam logic [5:0] Hpcr  = brick_regs_pkg::Hi08HpcrAddr[5:0];
  localparam logic [5:0] Hbar  = brick_regs_pkg::Hi08HbarAddr[5:0];
  localparam logic [5:0] Horx  = brick_regs_pkg::Hi08HorxAddr[5:0];
  localparam logic [5:0] Hotx  = brick_regs_pkg::Hi08HotxAddr[5:0];
  // INIT acts and is not kept.
  localparam logic [7:0] IcrKept = brick_regs_pkg::HostIoIcrWritten & ~(8'd1 << brick_regs_pkg::HostIoIcrInitLsb);

  // ---------------------------------------------------------------- accesses
  logic host_wr, host_rd_done, cpu_wr, horx_read, hotx_write, data7_read, data7_write, init, command_taken;
  assign host_wr       = hp_sel_i & hp_wr_i;
  assign host_rd_done  = hp_sel_i & hp_rd_done_i;
  assign cpu_wr        = dsp_sel_i & dsp_we_i;
  assign horx_read     = dsp_sel_i & dsp_rd_i & (dsp_addr_i == Horx);
  assign hotx_write    = cpu_wr & (dsp_addr_i == Hotx);
  assign data7_read    = host_rd_done & (hp_addr_i == Data7);
  assign data7_write   = host_wr & (hp_addr_i == Data7);
  assign command_taken = cpu_wr & (dsp_addr_i == Hsr) & dsp_wdata_i[brick_regs_pkg::Hi08HsrHcpLsb];
  assign init          = host_wr & (hp_addr_i == Icr) & hp_wdata_i[brick_regs_pkg::HostIoIcrInitLsb];

  // ---------------------------------------------------------------- registers
  logic [7:0]  icr_d, icr_q, cvr_d, cvr_q, ivr_q;
  logic [23:0] hcr_d, hcr_q, hpcr_q, hbar_q;
  logic [23:0] tx_q, horx_q, hotx_q, rx_q;
  logic        txde_d, txde_q, hrdf_d, hrdf_q, htde_d, htde_q, rxdf_d, rxdf_q;
  logic        hlend, tx_move, rx_move, hreq_d, hreq_q, irq_d, irq_q;
  logic        saw_q;  // the read under way found a word in RX
  assign hlend = icr_q[brick_regs_pkg::HostIoIcrHlendLsb];

  // A command written at the moment of taking is another one.
  always_comb begin
    icr_d = icr_q;
    cvr_d = cvr_q;
    hcr_d = hcr_q;
    if (command_taken) cvr_d[brick_regs_pkg::HostIoCvrHcLsb] = 1'b0;
    if (host_wr && hp_addr_i == Icr) icr_d = hp_wdata_i & IcrKept;
    if (host_wr && hp_addr_i == Cvr) cvr_d = hp_wdata_i;
    if (hp_reset_i) begin
      icr_d = brick_regs_pkg::HostIoIcrReset;
      cvr_d = brick_regs_pkg::HostIoCvrReset;
    end
    if (cpu_wr && dsp_addr_i == Hcr) hcr_d = dsp_wdata_i & brick_regs_pkg::Hi08HcrWritten;
  end

  // ---------------------------------------------------------------- flags
  // A read frees only what was full, one of the host what was full when its byte was taken; INIT and RESETDRV come
  // last, they win over all that happens in the same clock.
  assign tx_move = ~txde_q & ~hrdf_q;
  assign rx_move = ~htde_q & ~rxdf_q;
  always_comb begin
    txde_d = (txde_q | tx_move) & ~data7_write;
    hrdf_d = tx_move | (hrdf_q & ~horx_read);
    htde_d = (htde_q | rx_move) & ~hotx_write;
    rxdf_d = rx_move | (rxdf_q & ~(data7_read & saw_q));
    if (hp_reset_i || (init && hp_wdata_i[brick_regs_pkg::HostIoIcrTreqLsb])) begin
      txde_d = 1'b1;
      hrdf_d = 1'b0;
    end
    if (hp_reset_i || (init && hp_wdata_i[brick_regs_pkg::HostIoIcrRreqLsb])) begin
      rxdf_d = 1'b0;
      htde_d = 1'b1;
    end
  end

  // Requests are flip-flops: whoever looks at the pins sees nothing of a flag that goes while another comes.
  assign hreq_d = (icr_d[brick_regs_pkg::HostIoIcrRreqLsb] & rxdf_d) |
                  (icr_d[brick_regs_pkg::HostIoIcrTreqLsb] & txde_d);
  assign irq_d  = (hcr_d[brick_regs_pkg::Hi08HcrHrieLsb] & hrdf_d) | (hcr_d[brick_regs_pkg::Hi08HcrHtieLsb] & htde_d) |
                  (hcr_d[brick_regs_pkg::Hi08HcrHcieLsb] & cvr_d[brick_regs_pkg::HostIoCvrHcLsb]);

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      hreq_q <= 1'b0;
      irq_q  <= 1'b0;
      icr_q  <= brick_regs_pkg::HostIoIcrReset;
      cvr_q  <= brick_regs_pkg::HostIoCvrReset;
      ivr_q  <= brick_regs_pkg::HostIoIvrReset;
      hcr_q  <= brick_regs_pkg::Hi08HcrReset;
      hpcr_q <= brick_regs_pkg::Hi08HpcrReset;
      hbar_q <= brick_regs_pkg::Hi08HbarReset;
      tx_q   <= 24'h0;
      horx_q <= 24'h0;
      hotx_q <= 24'h0;
      rx_q   <= 24'h0;
      txde_q <= brick_regs_pkg::HostIoIsrReset[brick_regs_pkg::HostIoIsrTxdeLsb];
      rxdf_q <= brick_regs_pkg::HostIoIsrReset[brick_regs_pkg::HostIoIsrRxdfLsb];
      saw_q  <= 1'b0;
      hrdf_q <= brick_regs_pkg::Hi08HsrReset[brick_regs_pkg::Hi08HsrHrdfLsb];
      htde_q <= brick_regs_pkg::Hi08HsrReset[brick_regs_pkg::Hi08HsrHtdeLsb];
    end else begin
      hreq_q <= hreq_d;
      irq_q  <= irq_d;
      icr_q  <= icr_d;
      cvr_q  <= cvr_d;
      hcr_q  <= hcr_d;
      txde_q <= txde_d;
      hrdf_q <= hrdf_d;
      htde_q <= htde_d;
      rxdf_q <= rxdf_d;
      if (hp_sel_i & hp_rd_i) saw_q <= rxdf_q;
      if (tx_move) horx_q <= tx_q;
      if (rx_move) rx_q <= hotx_q;
      if (hotx_write) hotx_q <= dsp_wdata_i;
      if (host_wr) begin
        case (hp_addr_i)
          Ivr:     ivr_q <= hp_wdata_i;
          Data6:   tx_q[15:8] <= hp_wdata_i;
          Data5:   if (hlend) tx_q[7:0]   <= hp_wdata_i; else tx_q[23:16] <= hp_wdata_i;
          Data7:   if (hlend) tx_q[23:16] <= hp_wdata_i; else tx_q[7:0]   <= hp_wdata_i;
          default: ;
        endcase
      end
      if (hp_reset_i) ivr_q <= brick_regs_pkg::HostIoIvrReset;
      if (cpu_wr) begin
        case (dsp_addr_i)
          Hpcr:    hpcr_q <= dsp_wdata_i & brick_regs_pkg::Hi08HpcrWritten;
          Hbar:    hbar_q <= dsp_wdata_i & brick_regs_pkg::Hi08HbarWritten;
          default: ;
        endcase
      end
    end
  end

  assign txde_o = txde_q;
  assign rxdf_o = rxdf_q;

  // ---------------------------------------------------------------- what the two sides read
  assign hreq_o = hreq_q;
  assign irq_o  = irq_q;

  always_comb begin
    hp_rdata_o = 8'h00;
    case (hp_addr_i)
      Icr:   hp_rdata_o = icr_q;
      Cvr:   hp_rdata_o = cvr_q;
      Ivr:   hp_rdata_o = ivr_q;
      Data5: hp_rdata_o = hlend ? rx_q[7:0] : rx_q[23:16];
      Data6: hp_rdata_o = rx_q[15:8];
      Data7: hp_rdata_o = hlend ? rx_q[23:16] : rx_q[7:0];
      Isr: begin
        hp_rdata_o[brick_regs_pkg::HostIoIsrRxdfLsb] = rxdf_q;
        hp_rdata_o[brick_regs_pkg::HostIoIsrTxdeLsb] = txde_q;
        hp_rdata_o[brick_regs_pkg::HostIoIsrTrdyLsb] = txde_q & ~hrdf_q;
        hp_rdata_o[brick_regs_pkg::HostIoIsrHf2Lsb]  = hcr_q[brick_regs_pkg::Hi08HcrHf2Lsb];
        hp_rdata_o[brick_regs_pkg::HostIoIsrHf3Lsb]  = hcr_q[brick_regs_pkg::Hi08HcrHf3Lsb];
        hp_rdata_o[brick_regs_pkg::HostIoIsrHreqLsb] = hreq_q;
      end
      default: ;
    endcase
    dsp_rdata_o = 24'h0;
    case (dsp_addr_i)
      Hcr:  dsp_rdata_o = hcr_q;
      Hpcr: dsp_rdata_o = hpcr_q;
      Hbar: dsp_rdata_o = hbar_q;
      Horx: dsp_rdata_o = horx_q;
      Hsr: begin
        dsp_rdata_o[brick_regs_pkg::Hi08HsrHrdfLsb] = hrdf_q;
        dsp_rdata_o[brick_regs_pkg::Hi08HsrHtdeLsb] = htde_q;
        dsp_rdata_o[brick_regs_pkg::Hi08HsrHcpLsb]  = cvr_q[brick_regs_pkg::HostIoCvrHcLsb];
        dsp_rdata_o[brick_regs_pkg::Hi08HsrHf0Lsb]  = icr_q[brick_regs_pkg::HostIoIcrHf0Lsb];
        dsp_rdata_o[brick_regs_pkg::Hi08HsrHf1Lsb]  = icr_q[brick_regs_pkg::HostIoIcrHf1Lsb];
        dsp_rdata_o[brick_regs_pkg::Hi08HsrHvLsb +: brick_regs_pkg::Hi08HsrHvWidth] =
            cvr_q[brick_regs_pkg::HostIoCvrHvLsb +: brick_regs_pkg::HostIoCvrHvWidth];
      end
      default: ;
    endcase
  end

endmodule : host_port

`default_nettype wire
