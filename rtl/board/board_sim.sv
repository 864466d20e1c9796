// Simulation wrapper of the board: its pins packed into words as rtl/pins/board.pins places them (generate.py writes
// the parts between the marks), the motor side as systemc/core/motor_pins.h has it. Arrays of words, because a
// simulator then writes only the words that may have moved. start_seed_i, read once when the simulation begins, gives
// the dual-ported RAM its content (systemc/core/start_value.h). seeded_bug_i is the negative control of every
// comparison: the SERVO pin's SeededBugEdge-th falling edge since reset comes one tick late.
`default_nettype none

module board_sim #(
  parameter logic [17:0] ServoIcMask   = 18'h00003,
  parameter logic [3:0]  MacroIcMask   = 4'h0,
  parameter logic [7:0]  SeededBugEdge = 8'd5
) (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic [31:0] inputs_i[8],
  input  wire logic [31:0] start_seed_i,
  input  wire logic        seeded_bug_i,
  output logic [31:0]      pins_o[4],
  input  wire logic [motor_pins_pkg::Stride-1:0] motor_i[18],  // each servo IC as in board_top, also those not built
  output logic [motor_pins_pkg::Stride-1:0] motor_o[18],
  output logic [31:0]      count_o[72]   // no pins: position counters, channel n of IC i in word 4 * i + n - 1
);

  localparam integer MotorBits = ServoIcMask == 0 ? 1 : motor_pins_pkg::Stride * $countones(ServoIcMask);
  logic [MotorBits-1:0] motor_in, motor_out;
  if (ServoIcMask == 0) begin : gen_no_motors
    logic unused_out;
    assign motor_in   = motor_i[0][0];
    assign unused_out = &{1'b0, motor_out};
  end
  for (genvar i = 0; i < 18; i++) begin : gen_motor
    if (ServoIcMask[i]) begin : gen_built
      localparam integer Motor = motor_pins_pkg::Stride * $countones(ServoIcMask & ((18'd1 << i) - 18'd1));
      assign motor_in[Motor +: motor_pins_pkg::Stride] = motor_i[i];
      assign motor_o[i]          = motor_out[Motor +: motor_pins_pkg::Stride];
      for (genvar n = 0; n < 4; n++) begin : gen_count
        assign count_o[4*i+n] =
            {8'h0, u_board.gen_servo_ic[i].gen_built.u_servo_ic.u_channels.gen_channel[n].u_channel.counter_o};
      end
    end else begin : gen_absent
      assign motor_o[i] = '0;
      for (genvar n = 0; n < 4; n++) begin : gen_count
        assign count_o[4*i+n] = 32'h0;
      end
    end
  end

  // rows of rtl/pins/board.pins: nets
  logic [23:0] pa_data;
  logic        pa_ta_n;
  logic        irq_host;
  logic        phase;
  logic        servo;
  logic        breq;
  logic        ipos;
  logic        eror;
  logic        f1er;
  logic [15:0] isa_sd;
  logic        isa_iochrdy;
  logic        isa_memcs16_n;
  logic        isa_irq;
  logic        hreq;
  logic        wdo;
  logic        wd_tripped;
  logic        busy_host;
  logic        busy_cpu;
  logic [4:0]  phase_source;
  logic        source_conflict;
  logic [7:0]  pic_ist;
  logic [7:0]  pic_sig;
  logic [7:0]  pic_msk;
  logic [7:0]  pic_elr;
  logic [1:0]  isa_sd_oe;
  logic        port_txde;
  logic        port_rxdf;
  logic        pa_data_oe;
  logic        brld_n;
  logic        erld_n;
  logic        f1ld_n;
  logic        ipld_n;
  logic [1:0]  ctrl;
  logic        wd_relay;
  logic        wd_led;
  logic [7:0]  ssi_clk;
  // end of rows

  board_top #(.ServoIcMask(ServoIcMask), .MacroIcMask(MacroIcMask)) u_board (
    .clk_pwm_i, .clk_ref_i,
    .rst_pin_ni         (rst_ni),
    // rows of rtl/pins/board.pins: ports
    .pa_addr_i          (inputs_i[0][18:0]),
    .pa_x_i             (inputs_i[0][23]),
    .pa_aa_i            (inputs_i[0][22:19]),
    .pa_int_i           (inputs_i[0][24]),
    .pa_rd_ni           (inputs_i[0][25]),
    .pa_wr_ni           (inputs_i[0][26]),
    .pa_wdata_i         (inputs_i[1][23:0]),
    .isa_la_i           (inputs_i[6][6:0]),
    .isa_sa_i           (inputs_i[2][19:0]),
    .isa_sbhe_ni        (inputs_i[2][25]),
    .isa_sd_i           (inputs_i[3][15:0]),
    .isa_ior_ni         (inputs_i[2][20]),
    .isa_iow_ni         (inputs_i[2][21]),
    .isa_memr_ni        (inputs_i[2][22]),
    .isa_memw_ni        (inputs_i[2][23]),
    .isa_aen_i          (inputs_i[2][24]),
    .isa_resetdrv_i     (inputs_i[6][7]),
    .io_base_i          (inputs_i[6][15:8]),
    .io_decode16_i      (inputs_i[6][26]),
    .window_i           (inputs_i[6][25:16]),
    .window_flat_i      (inputs_i[6][27]),
    .slot8_i            (inputs_i[6][28]),
    .fitted_i           (inputs_i[4][21:0]),
    .macro_gate_i       (inputs_i[4][25:22]),
    .dpram_small_i      (inputs_i[4][26]),
    .jpan_fitted_i      (inputs_i[4][27]),
    .line_select_i      (inputs_i[5][11:0]),
    .ext_clock_i        (inputs_i[4][28]),
    .pic_8259_i         (inputs_i[5][16]),
    .ssi_kind_i         (inputs_i[5][18:17]),
    .jpan_i             (inputs_i[3][31:16]),
    .ext_phase_i        (inputs_i[4][29]),
    .ext_servo_i        (inputs_i[4][30]),
    .mi1_i              (inputs_i[5][12]),
    .mi2_i              (inputs_i[5][13]),
    .axexp0_i           (inputs_i[5][14]),
    .axexp1_i           (inputs_i[5][15]),
    .pwr_good_i         (inputs_i[7][0]),
    .ssi_data_i         (inputs_i[7][15:8]),
    .pa_data_o          (pa_data),
    .pa_ta_n_o          (pa_ta_n),
    .irq_host_o         (irq_host),
    .phase_o            (phase),
    .servo_o            (servo),
    .breq_o             (breq),
    .ipos_o             (ipos),
    .eror_o             (eror),
    .f1er_o             (f1er),
    .isa_sd_o           (isa_sd),
    .isa_iochrdy_o      (isa_iochrdy),
    .isa_memcs16_n_o    (isa_memcs16_n),
    .isa_irq_o          (isa_irq),
    .hreq_o             (hreq),
    .wdo_o              (wdo),
    .wd_tripped_o       (wd_tripped),
    .busy_host_o        (busy_host),
    .busy_cpu_o         (busy_cpu),
    .phase_source_o     (phase_source),
    .source_conflict_o  (source_conflict),
    .pic_ist_o          (pic_ist),
    .pic_sig_o          (pic_sig),
    .pic_msk_o          (pic_msk),
    .pic_elr_o          (pic_elr),
    .isa_sd_oe_o        (isa_sd_oe),
    .port_txde_o        (port_txde),
    .port_rxdf_o        (port_rxdf),
    .pa_data_oe_o       (pa_data_oe),
    .brld_n_o           (brld_n),
    .erld_n_o           (erld_n),
    .f1ld_n_o           (f1ld_n),
    .ipld_n_o           (ipld_n),
    .ctrl_o             (ctrl),
    .wd_relay_o         (wd_relay),
    .wd_led_o           (wd_led),
    .ssi_clk_o          (ssi_clk),
    // end of rows
    .motor_i            (motor_in),
    .motor_o            (motor_out)
  );

  function automatic logic [15:0] start_word(input logic [31:0] seed, input logic [31:0] index);
    logic [31:0] x;
    x = seed ^ (index * 32'h9E3779B9);
    x = (x ^ (x >> 16)) * 32'h7FEB352D;
    x = (x ^ (x >> 15)) * 32'h846CA68B;
    return (seed == 32'h0) ? 16'h0 : x[31:16];
  endfunction

  initial begin
    for (int i = 0; i < 32768; i++) u_board.u_core.u_dpram.u_memory.mem[i] = start_word(start_seed_i, i);
  end

  // A simulator resets at the fall of a reset only, so the board's must have been high before the first.
  initial u_board.u_core.u_reset_sync.u_pwm.sync2_q = 1'b1;

  // The deliberate bug: one tick of high level is added in front of one low phase of SERVO.
  logic       bug_q, servo_last_q;
  logic [7:0] falls_q;
  logic       fell, late;
  assign fell = servo_last_q & ~servo;
  assign late = bug_q & fell & (falls_q == SeededBugEdge - 8'd1);
  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      bug_q        <= 1'b0;
      servo_last_q <= 1'b1;
      falls_q      <= 8'd0;
    end else begin
      bug_q <= seeded_bug_i;
      if (bug_q) begin
        servo_last_q <= servo;
        if (fell && falls_q != 8'hFF) falls_q <= falls_q + 8'd1;
      end
    end
  end

  // rows of rtl/pins/board.pins: words
  assign pins_o[0] = {f1er, eror, ipos, breq, servo | late, phase, irq_host, pa_ta_n, pa_data};
  assign pins_o[1] = {2'h0, source_conflict, phase_source, busy_cpu, busy_host, wd_tripped, wdo, hreq, isa_irq,
                      isa_memcs16_n, isa_iochrdy, isa_sd};
  assign pins_o[2] = {pic_elr, pic_msk, pic_sig, pic_ist};
  assign pins_o[3][7:0] = {7'h0, pa_data_oe};
  assign pins_o[3][15:8] = {2'h0, wd_led, wd_relay, port_rxdf, port_txde, isa_sd_oe};
  assign pins_o[3][23:16] = {2'h0, ctrl[1], ctrl[0], ipld_n, f1ld_n, erld_n, brld_n};
  assign pins_o[3][31:24] = {ssi_clk};
  // end of rows

endmodule : board_sim

`default_nettype wire
