// The controller board but its servo ICs: MACRO ICs, clock selection, bus decoding, watchdog and the host side, from
// Port A pins to ISA pins. board_top puts servo ICs beside it, board_chip leaves them to chips of their own: then
// ServoChips is 1, and a read of a servo IC is answered by its chip. clk_ref_i rises together with every third
// clk_pwm_i edge; both are of one phase, so crossing between them is synchronous. ServoIcMask and MacroIcMask say which
// ICs there can be (bits 17..0 and 21..18 as in fitted_i), fitted_i which of those are present at run time,
// macro_gate_i which MACRO ICs are of the kind MACROGATE. Outputs are registers or gates behind registers, but for what
// a strobe moves without a clock: /TA, data enables. docs/architecture.md has the map.
`default_nettype none

module board_core #(
  parameter logic [17:0] ServoIcMask = 18'h00003,
  parameter logic [3:0]  MacroIcMask = 4'h0,
  parameter logic        ServoChips  = 1'b0
) (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_pin_ni,
  // Port A
  input  wire logic [18:0] pa_addr_i,
  input  wire logic        pa_x_i,
  input  wire logic [3:0]  pa_aa_i,
  input  wire logic        pa_int_i,
  input  wire logic        pa_rd_ni,
  input  wire logic        pa_wr_ni,
  input  wire logic [23:0] pa_wdata_i,
  output logic [23:0]      pa_data_o,
  output logic             pa_data_oe_o,
  output logic             pa_ta_n_o,
  output logic             irq_host_o,
  // ISA; SD is driven for each byte lane, IOCHRDY and MEMCS16# are open collector: 0 pulls, 1 lets go
  input  wire logic [6:0]  isa_la_i,  // LA[23:17]
  input  wire logic [19:0] isa_sa_i,
  input  wire logic [15:0] isa_sd_i,
  input  wire logic        isa_ior_ni,
  input  wire logic        isa_iow_ni,
  input  wire logic        isa_memr_ni,
  input  wire logic        isa_memw_ni,
  input  wire logic        isa_aen_i,
  input  wire logic        isa_sbhe_ni,
  input  wire logic        isa_resetdrv_i,
  output logic [15:0]      isa_sd_o,
  output logic [1:0]       isa_sd_oe_o,
  output logic             isa_iochrdy_o,
  output logic             isa_memcs16_n_o,
  output logic             isa_irq_o,
  // straps and external clocks
  input  wire logic [21:0] fitted_i,
  input  wire logic [3:0]  macro_gate_i,
  input  wire logic        dpram_small_i,  // 8192 words, not 32768
  input  wire logic        jpan_fitted_i,
  // Sources of IR5 (3..0), IR6, IR7: 0 none, 1..8 EQU1..EQU8, 9 WDO, 10 CTRL0, 11 CTRL1, 12 MI1, 13 MI2, 14 AXEXP0,
  // 15 AXEXP1
  input  wire logic [11:0] line_select_i,
  input  wire logic        pic_8259_i,     // the interrupt controller is an 8259
  input  wire logic [1:0]  ssi_kind_i,     // serial encoder inputs: 0 none, 1 Geo PMAC, 2 Geo Brick LV, 3 page alone
  input  wire logic [7:0]  io_base_i,      // A11..A4 of the host's I/O block
  input  wire logic        io_decode16_i,
  input  wire logic [9:0]  window_i,       // A23..A14 of the host's memory window
  input  wire logic        window_flat_i,
  input  wire logic        slot8_i,
  input  wire logic        ext_clock_i,
  input  wire logic        ext_phase_i,
  input  wire logic        ext_servo_i,
  input  wire logic        pwr_good_i,  // 5 V is good
  input  wire logic [15:0] jpan_i,  // control panel inputs, low-true
  input  wire logic        mi1_i,   // machine inputs of JOPTO
  input  wire logic        mi2_i,
  input  wire logic        axexp0_i,  // interrupt lines of an axis expansion board
  input  wire logic        axexp1_i,
  input  wire logic [7:0]  ssi_data_i,  // absolute encoders, channel 1 in bit 0
  // clocks, host signals, watchdog, interrupt controller as seen from outside
  output logic             breq_o,
  output logic             ipos_o,
  output logic             eror_o,
  output logic             f1er_o,
  output logic             hreq_o,
  output logic             port_txde_o,
  output logic             port_rxdf_o,
  output logic             wdo_o,
  output logic             wd_tripped_o,
  output logic             wd_relay_o,      // energised
  output logic             wd_led_o,
  output logic             busy_host_o,
  output logic             busy_cpu_o,
  output logic [4:0]       phase_source_o,
  output logic             source_conflict_o,
  output logic             brld_n_o,  // lamps of the control panel
  output logic             erld_n_o,
  output logic             f1ld_n_o,
  output logic             ipld_n_o,
  output logic [1:0]       ctrl_o,
  output logic [7:0]       ssi_clk_o,
  output logic [7:0]       pic_ist_o,
  output logic [7:0]       pic_sig_o,
  output logic [7:0]       pic_msk_o,
  output logic [7:0]       pic_elr_o,
  // PHASE and SERVO: the nets, and how clock_select drives them
  input  wire logic        phase_i,
  input  wire logic        servo_i,
  output logic             phase_o,
  output logic             servo_o,
  output logic             phase_oe_o,
  output logic             servo_oe_o,
  // servo ICs: reset, a trip before its edge, the bus on clk_ref_i with a select each, read data of the selected one,
  // else 0; their clock pins; EQU of ICs 0 and 1
  output logic             rst_no,
  output logic             rst_ref_no,   // released with clk_ref_i, two clk_pwm_i edges before rst_no
  output logic             trip_d_o,
  output logic [17:0]      ic_sel_o,
  output logic             bus_x_o,
  output logic [4:0]       bus_addr_o,
  output logic             bus_we_o,
  output logic             bus_rd_o,
  output logic [23:0]      bus_wdata_o,
  input  wire logic [23:0] ic_rdata_i,
  input  wire logic [17:0] ic_phase_i,
  input  wire logic [17:0] ic_servo_i,
  input  wire logic [17:0] ic_phase_oe_i,
  input  wire logic [17:0] ic_servo_oe_i,
  input  wire logic [7:0]  equ_i
);

  logic rst_ni;  // of every block
  reset_sync u_reset_sync (
    .clk_pwm_i, .clk_ref_i, .rst_pin_ni,
    .rst_ref_no,
    .rst_no (rst_ni)
  );
  assign rst_no = rst_ni;

  // ------------------------------------------------------------------ straps, taken over on clk_ref
  localparam logic [21:0] IcMask = {MacroIcMask, ServoIcMask};
  logic [21:0] fitted_q;
  logic [3:0]  macro_gate_q;
  logic        ext_clock_q, dpram_small_q, jpan_fitted_q, pic_8259_q;
  logic [11:0] line_select_q;
  logic [1:0]  ssi_kind_q;
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      fitted_q      <= 22'h0;
      macro_gate_q  <= 4'h0;
      ext_clock_q   <= 1'b0;
      dpram_small_q <= 1'b0;
      jpan_fitted_q <= 1'b0;
      line_select_q <= 12'h0;
      pic_8259_q    <= 1'b0;
      ssi_kind_q    <= 2'd0;
    end else begin
      fitted_q      <= fitted_i;
      macro_gate_q  <= macro_gate_i & MacroIcMask;
      ext_clock_q   <= ext_clock_i;
      dpram_small_q <= dpram_small_i;
      jpan_fitted_q <= jpan_fitted_i;
      line_select_q <= line_select_i;
      pic_8259_q    <= pic_8259_i;
      ssi_kind_q    <= ssi_kind_i;
    end
  end

  // ------------------------------------------------------------------ Port A: synchroniser and decoding
  logic [18:0] bus_addr;
  logic        bus_x, bus_int, bus_we, bus_rd;
  logic [3:0]  bus_aa;
  logic [23:0] bus_wdata;

  logic [1:0] rd_falls, wr_falls, bus_rd_falls;
  bus_strobes u_bus_strobes (
    .rst_ni, .pa_rd_ni, .pa_wr_ni,
    .rd_falls_o (rd_falls),
    .wr_falls_o (wr_falls)
  );

  bus_sync u_bus_sync (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .rd_falls_i (rd_falls),
    .wr_falls_i (wr_falls),
    .pa_rd_ni, .pa_wr_ni,
    .pa_addr_i, .pa_x_i, .pa_aa_i, .pa_int_i, .pa_wdata_i,
    .addr_o  (bus_addr),
    .x_o     (bus_x),
    .aa_o    (bus_aa),
    .int_o   (bus_int),
    .wdata_o (bus_wdata),
    .we_o    (bus_we),
    .rd_o    (bus_rd),
    .rd_falls_o (bus_rd_falls)
  );

  logic        sel_any, sel_int, sel_port, sel_signals, sel_strobe, sel_ctrl, sel_panel, sel_ssi;
  logic [21:0] sel_ic;
  address_decode u_address_decode (
    .addr_i        (bus_addr),
    .x_i           (bus_x),
    .aa_i          (bus_aa),
    .int_i         (bus_int),
    .fitted_i      (fitted_q & IcMask),
    .jpan_i        (jpan_fitted_q),
    .ssi_i         (ssi_kind_q),
    .sel_any_o     (sel_any),
    .sel_int_o     (sel_int),
    .sel_port_o    (sel_port),
    .sel_signals_o (sel_signals),
    .sel_strobe_o  (sel_strobe),
    .sel_ctrl_o    (sel_ctrl),
    .sel_panel_o   (sel_panel),
    .sel_ssi_o     (sel_ssi),
    .sel_ic_o      (sel_ic)
  );
  logic unused_sel;  // of ICs that are not built
  assign unused_sel = &{1'b0, sel_ic};

  assign ic_sel_o    = sel_ic[17:0];
  assign bus_x_o     = bus_x;
  assign bus_addr_o  = bus_addr[4:0];
  assign bus_we_o    = bus_we;
  assign bus_rd_o    = bus_rd;
  assign bus_wdata_o = bus_wdata;

  // ------------------------------------------------------------------ MACRO ICs and the board's clock nets
  logic [21:0] ic_phase, ic_servo, ic_phase_oe, ic_servo_oe;
  assign ic_phase[17:0]    = ic_phase_i;
  assign ic_servo[17:0]    = ic_servo_i;
  assign ic_phase_oe[17:0] = ic_phase_oe_i;
  assign ic_servo_oe[17:0] = ic_servo_oe_i;

  logic [4*24-1:0] macro_rdata;  // 0 of each that is not selected

  for (genvar i = 18; i < 22; i++) begin : gen_macro_ic
    if (IcMask[i]) begin : gen_built
      macro_ic u_macro_ic (
        .clk_pwm_i, .clk_ref_i, .rst_ni,
        .gate_i     (macro_gate_q[i-18]),
        .sel_i      (sel_ic[i]),
        .x_i        (bus_x),
        .addr_i     (bus_addr[5:0]),
        .we_i       (bus_we),
        .wdata_i    (bus_wdata),
        .rdata_o    (macro_rdata[24*(i-18)+:24]),
        .phase_i,
        .servo_i,
        .phase_o    (ic_phase[i]),
        .servo_o    (ic_servo[i]),
        .phase_oe_o (ic_phase_oe[i]),
        .servo_oe_o (ic_servo_oe[i])
      );
    end else begin : gen_absent
      assign macro_rdata[24*(i-18)+:24] = 24'h0;
      assign ic_phase[i]        = 1'b1;
      assign ic_servo[i]        = 1'b1;
      assign ic_phase_oe[i]     = 1'b0;
      assign ic_servo_oe[i]     = 1'b0;
    end
  end

  // Kinds of MACRO ICs that are not built mean nothing.
  logic unused_gate;
  assign unused_gate = &{1'b0, macro_gate_q};

  clock_select u_clock_select (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .fitted_i    (fitted_q),
    .phase_i     (ic_phase),
    .servo_i     (ic_servo),
    .phase_oe_i  (ic_phase_oe),
    .servo_oe_i  (ic_servo_oe),
    .ext_clock_i (ext_clock_q),
    .ext_phase_i, .ext_servo_i,
    .phase_o, .servo_o, .phase_oe_o, .servo_oe_o, .phase_source_o,
    .conflict_o  (source_conflict_o)
  );

  watchdog u_watchdog (
    .clk_ref_i, .rst_ni,
    .strobe_i (bus_we & sel_strobe),
    .servo_i, .pwr_good_i,
    .trip_d_o,
    .trip_o   (wd_tripped_o),
    .relay_o  (wd_relay_o)
  );
  assign wdo_o    = wd_tripped_o;
  assign wd_led_o = wd_tripped_o;

  // ------------------------------------------------------------------ absolute encoders
  logic [23:0] ssi_rdata;
  ssi u_ssi (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .geo_i   (ssi_kind_q[0]),
    .sel_i   (sel_ssi),
    .x_i     (bus_x),
    .addr_i  (bus_addr[5:0]),
    .we_i    (bus_we),
    .rd_i    (bus_rd),
    .wdata_i (bus_wdata),
    .rdata_o (ssi_rdata),
    .phase_i, .servo_i,
    .data_i  (ssi_data_i),
    .clk_o   (ssi_clk_o)
  );

  // ------------------------------------------------------------------ host side
  logic       hp_sel, hp_rd, hp_rd_done, hp_wr;
  logic [2:0] hp_addr;
  logic [7:0] hp_wdata, hp_rdata;
  logic       pic_sel, pic_wr, pic_rd, host_reset;
  logic [1:0] pic_addr;
  logic [7:0] pic_wdata, pic_rdata;
  logic        mem_sel, mem_rd, mem_wr, mem_busy_d;
  logic [14:0] mem_addr;
  logic [1:0]  mem_be;
  logic [15:0] mem_wdata, mem_rdata;

  isa_slave u_isa_slave (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .isa_la_i, .isa_sa_i, .isa_sd_i, .isa_ior_ni, .isa_iow_ni, .isa_memr_ni, .isa_memw_ni, .isa_aen_i, .isa_sbhe_ni,
    .isa_resetdrv_i, .isa_sd_o, .isa_sd_oe_o, .isa_iochrdy_o,
    .isa_memcs16_no (isa_memcs16_n_o),
    .io_base_i, .io_decode16_i, .window_i, .window_flat_i, .slot8_i,
    .host_reset_o   (host_reset),
    .hp_sel_o       (hp_sel),
    .hp_rd_o        (hp_rd),
    .hp_rd_done_o   (hp_rd_done),
    .hp_wr_o        (hp_wr),
    .hp_addr_o      (hp_addr),
    .hp_wdata_o     (hp_wdata),
    .hp_rdata_i     (hp_rdata),
    .pic_sel_o      (pic_sel),
    .pic_wr_o       (pic_wr),
    .pic_rd_o       (pic_rd),
    .pic_addr_o     (pic_addr),
    .pic_wdata_o    (pic_wdata),
    .pic_rdata_i    (pic_rdata),
    .mem_sel_o      (mem_sel),
    .mem_rd_o       (mem_rd),
    .mem_wr_o       (mem_wr),
    .mem_addr_o     (mem_addr),
    .mem_be_o       (mem_be),
    .mem_wdata_o    (mem_wdata),
    .mem_rdata_i    (mem_rdata),
    .mem_busy_d_i   (mem_busy_d)
  );

  logic [23:0] int_rdata;
  host_port u_host_port (
    .clk_ref_i, .rst_ni,
    .hp_sel_i      (hp_sel),
    .hp_rd_i       (hp_rd),
    .hp_rd_done_i  (hp_rd_done),
    .hp_wr_i       (hp_wr),
    .hp_addr_i     (hp_addr),
    .hp_wdata_i    (hp_wdata),
    .hp_rdata_o    (hp_rdata),
    .hp_reset_i    (host_reset),
    .dsp_sel_i     (sel_port),
    .dsp_we_i      (bus_we),
    .dsp_rd_i      (bus_rd),
    .dsp_addr_i    (bus_addr[5:0]),
    .dsp_wdata_i   (bus_wdata),
    .dsp_rdata_o   (int_rdata),
    .hreq_o,
    .irq_o         (irq_host_o),
    .txde_o        (port_txde_o),
    .rxdf_o        (port_rxdf_o)
  );

  // A trip empties the latch of the control outputs with the edge that trips, so that they go off with all others, as
  // flip-flops, and nothing comes back with the reset.
  logic [3:0] signals_rdata;
  host_signals u_host_signals (
    .clk_ref_i, .rst_ni,
    .trip_i    (trip_d_o),
    .wr_i      (bus_we & sel_signals),
    .ctrl_wr_i (bus_we & sel_ctrl),
    .wdata_i   (bus_wdata[3:0]),
    .rdata_o   (signals_rdata),
    .ctrl_o,
    .ipos_o, .breq_o, .eror_o, .f1er_o
  );

  // Lines of the interrupt controller: IPOS, BREQ, EROR, F1ER, HREQ from bit 0 up, then three that the board chooses.
  // EQU1..EQU4 are the channels of servo IC 0, EQU5..EQU8 those of IC 1. The choice is a strap: it stands still while
  // lines from outside pass on to the flip-flops in the controllers, which are the first to look at them.
  logic [7:0]  pic_line;
  logic [15:0] line_source;
  logic [7:0]  equ;
  assign equ         = equ_i & {{4{fitted_q[1]}}, {4{fitted_q[0]}}};
  assign line_source = {axexp1_i, axexp0_i, mi2_i, mi1_i, ctrl_o, wdo_o, equ, 1'b0};
  assign pic_line = {line_source[line_select_q[11:8]], line_source[line_select_q[7:4]], line_source[line_select_q[3:0]],
                     hreq_o, f1er_o, eror_o, breq_o, ipos_o};
  logic [7:0] turbo_rdata, turbo_ist, turbo_msk, turbo_elr, old_rdata, old_irr, old_isr, old_imr;
  logic       turbo_request, turbo_served, old_request, old_served, old_level;
  interrupt_controller u_interrupt_controller (
    .clk_ref_i, .rst_ni,
    .reset_i   (host_reset),
    .line_i    (pic_line),
    .wr_i      (pic_sel & pic_wr & ~pic_8259_q),
    .addr_i    (pic_addr),
    .wdata_i   (pic_wdata),
    .rdata_o   (turbo_rdata),
    .ist_o     (turbo_ist),
    .sig_o     (pic_sig_o),
    .msk_o     (turbo_msk),
    .elr_o     (turbo_elr),
    .request_o (turbo_request),
    .served_o  (turbo_served)
  );

  pic_8259 u_pic_8259 (
    .clk_ref_i, .rst_ni,
    .line_i    (pic_line),
    .rd_i      (pic_rd & pic_8259_q),
    .wr_i      (pic_sel & pic_wr & pic_8259_q),
    .addr_i    (pic_addr),
    .wdata_i   (pic_wdata),
    .rdata_o   (old_rdata),
    .irr_o     (old_irr),
    .isr_o     (old_isr),
    .imr_o     (old_imr),
    .level_o   (old_level),
    .request_o (old_request),
    .served_o  (old_served)
  );
  logic unused_isr;
  assign unused_isr = &{1'b0, old_isr};
  assign pic_rdata  = pic_8259_q ? old_rdata : turbo_rdata;
  assign pic_ist_o  = pic_8259_q ? old_irr & ~old_imr : turbo_ist;
  assign pic_msk_o  = pic_8259_q ? ~old_imr : turbo_msk;
  assign pic_elr_o  = pic_8259_q ? {8{old_level}} : turbo_elr;

  host_interrupt u_host_interrupt (
    .clk_ref_i, .rst_ni,
    .request_i (pic_8259_q ? old_request : turbo_request),
    .served_i  (pic_8259_q ? old_served : turbo_served),
    .irq_o     (isa_irq_o)
  );

  logic [15:0] panel_rdata;
  panel_port u_panel_port (
    .clk_ref_i, .rst_ni, .jpan_i,
    .rdata_o  (panel_rdata),
    .fitted_i (jpan_fitted_q),
    .breq_i   (breq_o),
    .eror_i   (eror_o),
    .f1er_i   (f1er_o),
    .ipos_i   (ipos_o),
    .brld_no  (brld_n_o),
    .erld_no  (erld_n_o),
    .f1ld_no  (f1ld_n_o),
    .ipld_no  (ipld_n_o)
  );

  logic        dpram_sel;
  logic [15:0] dpram_rdata;
  logic        dpram_drive;
  assign dpram_sel = pa_aa_i[2] & ~pa_int_i;
  dpram u_dpram (
    .clk_pwm_i, .clk_ref_i, .rst_ni,
    .small_i      (dpram_small_q),
    .rd_falls_i   (rd_falls),
    .wr_falls_i   (wr_falls),
    .cpu_sel_i    (dpram_sel),
    .cpu_x_i      (pa_x_i),
    .cpu_addr_i   (pa_addr_i[13:0]),
    .cpu_rd_ni    (pa_rd_ni),
    .cpu_wr_ni    (pa_wr_ni),
    .cpu_wdata_i  (pa_wdata_i[15:0]),
    .cpu_rdata_o  (dpram_rdata),
    .cpu_drive_o  (dpram_drive),
    .cpu_wait_o   (pa_ta_n_o),
    .cpu_busy_o   (busy_cpu_o),
    .mem_sel_i    (mem_sel),
    .mem_rd_i     (mem_rd),
    .mem_wr_i     (mem_wr),
    .mem_addr_i   (mem_addr),
    .mem_be_i     (mem_be),
    .mem_wdata_i  (mem_wdata),
    .mem_rdata_o  (mem_rdata),
    .mem_busy_d_o (mem_busy_d),
    .host_busy_o  (busy_host_o)
  );

  // ------------------------------------------------------------------ read data towards the CPU
  logic [23:0] reg_rdata, bus_rdata;
  logic        bus_rdata_oe;
  always_comb begin
    reg_rdata = ic_rdata_i;
    for (int unsigned i = 0; i < 4; i++) begin
      if (MacroIcMask[i]) reg_rdata = reg_rdata | macro_rdata[24*i+:24];
    end
    if (sel_int)          reg_rdata = int_rdata & {24{sel_port}};
    else if (sel_signals) reg_rdata = {20'h0, signals_rdata};
    else if (sel_ctrl)    reg_rdata = {22'h0, ctrl_o};
    else if (sel_panel)   reg_rdata = {8'h0, panel_rdata};
    else if (sel_ssi)     reg_rdata = ssi_rdata;
  end
  logic answers;  // to a read of a region of registers
  assign answers = sel_any & ~(ServoChips & (ic_sel_o != 18'h0));
  bus_read u_bus_read (
    .clk_ref_i, .rst_ni, .pa_rd_ni,
    .rd_falls_i (rd_falls),
    .rd_i       (bus_rd),
    .of_i       (bus_rd_falls),
    .sel_any_i  (answers),
    .sel_int_i  (sel_int),
    .data_i     (reg_rdata),
    .data_o     (bus_rdata),
    .oe_o       (bus_rdata_oe)
  );

  assign pa_data_o    = dpram_drive ? {8'h0, dpram_rdata} : bus_rdata;
  assign pa_data_oe_o = bus_rdata_oe | dpram_drive;

endmodule : board_core

`default_nettype wire
