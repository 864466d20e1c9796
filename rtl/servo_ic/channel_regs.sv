// Registers of one channel: control word, output commands, latched error bits, and the read multiplexer of its eight addresses.
// X:+4 belongs to the IC and reads 0 here. Clock clk_ref_i, asynchronous reset. docs/registers.md, servo_channel.
`default_nettype none

module channel_regs (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  // bus: we_i is high for the one clk_ref edge that writes
  input  wire logic        x_i,
  input  wire logic [2:0]  addr_i,
  input  wire logic        sel_i,
  input  wire logic        we_i,
  input  wire logic [23:0] wdata_i,
  output logic [23:0]      rdata_o,       // 0 when not selected
  input  wire logic        trip_i,        // outputs ignore writes
  // written words
  output logic [23:0]      control_o,
  output logic [23:0]      out_a_o,
  output logic [23:0]      out_b_o,
  output logic [23:0]      out_c_o,
  output logic [5:0]       compare_we_o,  // A, B, increment, fraction of A, fraction of B, EQU
  // read words
  input  wire logic [11:0] level_i,
  input  wire logic        error_i,       // this edge sees an illegal transition, an encoder loss
  input  wire logic        loss_i,
  input  wire logic        equ_i,
  input  wire logic        incomplete_i,
  input  wire logic        captured_i,
  input  wire logic        captured_gi_i,
  input  wire logic [2:0]  hall_i,
  input  wire logic [23:0] phase_pos_i,
  input  wire logic [23:0] servo_pos_i,
  input  wire logic [23:0] servo_t1_i,
  input  wire logic [22:0] servo_t2_i,
  input  wire logic [11:0] servo_fraction_i,
  input  wire logic [23:0] capture_pos_i,
  input  wire logic [11:0] capture_fraction_i,
  input  wire logic [17:0] adc_a_i,
  input  wire logic [17:0] adc_b_i,
  input  wire logic [23:0] compare_a_i,
  input  wire logic [23:0] compare_b_i,
  input  wire logic [23:0] compare_inc_i,
  input  wire logic [11:0] a_fraction_i,
  input  wire logic [11:0] b_fraction_i
);

  logic [23:0] control_q, out_a_q, out_b_q, out_c_q;
  logic        error_q, loss_q, fine, we_status, we_control;
  assign fine = control_q[18];

  always_comb begin
    we_status    = 1'b0;
    we_control   = 1'b0;
    compare_we_o = 6'd0;
    if (we_i) begin
      case ({x_i, addr_i})
        4'd0:    compare_we_o[4] = fine;
        4'd1:    compare_we_o[3] = fine;
        4'd7:    compare_we_o[0] = 1'b1;
        4'd8:    we_status       = 1'b1;
        4'd13: begin
          we_control      = 1'b1;
          compare_we_o[5] = wdata_i[11];
        end
        4'd14:   compare_we_o[2] = 1'b1;
        4'd15:   compare_we_o[1] = 1'b1;
        default: we_status = 1'b0;
      endcase
    end
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      control_q <= 24'd0;
      out_a_q   <= 24'd0;
      out_b_q   <= 24'd0;
      out_c_q   <= 24'd0;
      error_q   <= 1'b0;
      loss_q    <= 1'b0;
    end else begin
      if (we_control)         control_q     <= wdata_i;
      else if (control_q[11]) control_q[11] <= 1'b0;  // falls back by itself
      if (we_i && !x_i && !trip_i) begin
        if (addr_i == 3'd2) out_a_q <= wdata_i;
        if (addr_i == 3'd3) out_b_q <= wdata_i;
        if (addr_i == 3'd4) out_c_q <= wdata_i;
      end
      // Any write clears the error, a 0 clears the loss; both come back with the next SCLK if the cause lasts.
      if (we_status || control_q[10])   error_q <= 1'b0;
      else if (error_i)                 error_q <= 1'b1;
      if (we_status && !wdata_i[7])     loss_q  <= 1'b0;
      else if (loss_i)                  loss_q  <= 1'b1;
    end
  end

  always_comb begin
    rdata_o = 24'd0;
    if (sel_i) begin
      case ({x_i, addr_i})
        4'd0:    rdata_o = fine ? {capture_fraction_i, b_fraction_i} : servo_t1_i;
        4'd1:    rdata_o = fine ? {servo_fraction_i, a_fraction_i} : {1'b0, servo_t2_i};
        4'd2:    rdata_o = out_a_q;
        4'd3:    rdata_o = out_b_q;
        4'd4:    rdata_o = out_c_q;
        4'd5:    rdata_o = {adc_a_i, 6'd0};
        4'd6:    rdata_o = {adc_b_i, 6'd0};
        4'd7:    rdata_o = compare_a_i;
        4'd8:    rdata_o = {level_i, captured_i, captured_gi_i, equ_i, error_q, loss_q, 3'b000, incomplete_i, hall_i};
        4'd9:    rdata_o = phase_pos_i;
        4'd10:   rdata_o = servo_pos_i;
        4'd11:   rdata_o = capture_pos_i;
        4'd13:   rdata_o = control_q;
        4'd14:   rdata_o = compare_inc_i;
        4'd15:   rdata_o = compare_b_i;
        default: rdata_o = 24'd0;
      endcase
    end
  end

  assign control_o = control_q;
  assign out_a_o   = out_a_q;
  assign out_b_o   = out_b_q;
  assign out_c_o   = out_c_q;

endmodule : channel_regs

`default_nettype wire
