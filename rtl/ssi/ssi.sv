// Serial encoder inputs (SSI): eight channels in two groups of four on a Geo Brick LV, or the two of a Geo PMAC, which
// are the first two of the first group. geo_i tells which, a strap. Registers of both are words of a page of 64
// addresses: Geo PMAC Y and X:$FF54, $FF74, X:$FF55, $FF56, $FF76, Brick Y and X:$78B20 to $78B3F. Bus on clk_ref_i,
// frames on clk_pwm_i, asynchronous reset. docs/ssi.md, servo-ic:11.3, servo-ic:11.4.
`default_nettype none

module ssi (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        geo_i,
  // bus: we_i, rd_i are high for the one clk_ref edge that writes, samples; rdata_o follows the address
  input  wire logic        sel_i,
  input  wire logic        x_i,
  input  wire logic [5:0]  addr_i,
  input  wire logic        we_i,
  input  wire logic        rd_i,
  input  wire logic [23:0] wdata_i,
  output logic [23:0]      rdata_o,
  // nets
  input  wire logic        phase_i,
  input  wire logic        servo_i,
  // encoders
  input  wire logic [7:0]  data_i,
  output logic [7:0]       clk_o
);

  // ------------------------------------------------------------------ decoding
  // A channel has four addresses: Y position, X control; Y high part, X refused triggers; two more. The last X of a
  // group is the group's. On a Geo PMAC refused triggers come two addresses after the control, the group's word one.
  logic       geo_hit, brick_hit, hit, first, group_word_here;
  logic [2:0] channel;
  logic [1:0] place, low;  // 0 position or control, 1 high part or refused triggers, 2 the group's word
  assign low       = addr_i[1:0];
  assign first     = ~addr_i[5];
  assign geo_hit   = (addr_i[4:2] == 3'b101) & ((low == 2'd0) | (x_i & ((low == 2'd2) | (first & (low == 2'd1)))));
  assign brick_hit = addr_i[5] & (~low[1] | (x_i & (addr_i[3:0] == 4'hF)));
  assign hit       = sel_i & (geo_i ? geo_hit : brick_hit);
  assign channel   = geo_i ? {2'b00, addr_i[5]} : addr_i[4:2];
  assign place     = geo_i ? {low[0], low[1]} : (low[1] ? 2'd2 : low);
  assign group_word_here = hit & (place == 2'd2);

  // ------------------------------------------------------------------ groups
  logic phase_rise, phase_fall, servo_rise, servo_fall;
  ssi_edges u_edges (
    .clk_pwm_i, .phase_i, .servo_i,
    .phase_rise_o(phase_rise), .phase_fall_o(phase_fall), .servo_rise_o(servo_rise), .servo_fall_o(servo_fall)
  );

  logic [7:0]  enable, active;
  logic [1:0]  moves, start, refuse, fall, rise;
  logic [43:0] group_word;  // without bits 11, 10
  for (genvar g = 0; g < 2; g++) begin : gen_group
    logic [21:0] word_q;
    always_ff @(posedge clk_ref_i or negedge rst_ni) begin
      if (!rst_ni) word_q <= 22'h0;
      else if (group_word_here && we_i && channel[2] == (g == 1))
        word_q <= geo_i ? {20'h0, wdata_i[1:0]} : {wdata_i[23:12], wdata_i[9:0]};
    end
    assign group_word[22*g+:22] = word_q;
    ssi_group u_group (
      .clk_pwm_i, .rst_ni, .geo_i,
      .divisor_i    (word_q[21:14]),
      .power_i      (word_q[13:10]),
      .servo_i      (word_q[9]),
      .falling_i    (word_q[8]),
      .delay_i      (word_q[7:4]),
      .code_i       (word_q[3:0]),
      .phase_rise_i (phase_rise),
      .phase_fall_i (phase_fall),
      .servo_rise_i (servo_rise),
      .servo_fall_i (servo_fall),
      .enabled_i    (|enable[4*g+:4]),
      .active_i     (|active[4*g+:4]),
      .start_o      (start[g]),
      .refuse_o     (refuse[g]),
      .fall_o       (fall[g]),
      .rise_o       (rise[g]),
      .moves_o      (moves[g])
    );
  end

  // ------------------------------------------------------------------ channels
  logic [7:0]   data;
  sync2 #(.Width(8), .Reset(8'hFF)) u_sync (.clk_i(clk_pwm_i), .rst_ni, .d_i(data_i), .q_o(data));

  logic [127:0] control;
  logic [255:0] position;
  logic [71:0]  high;
  logic [63:0]  refused;
  for (genvar n = 0; n < 8; n++) begin : gen_channel
    logic       here, begins, shot, single, driver, gray, odd, even, parity_error;
    logic [5:0] bits;
    assign here = hit & (channel == n[2:0]) & (place == 2'd0);
    ssi_channel_regs u_regs (
      .clk_ref_i, .rst_ni, .geo_i,
      .we_i           (here & x_i & we_i),
      .rd_a_i         (here & ~x_i & rd_i),
      .flags_i        (wdata_i[15:10]),
      .count_i        (wdata_i[5:0]),
      .word_o         (control[16*n+:16]),
      .high_o         (high[9*n+:9]),
      .single_i       (begins),
      .shot_i         (shot),
      .position_i     (position[32*n+24+:8]),
      .parity_error_i (parity_error),
      .enable_o       (enable[n]),
      .shot_o         (single),
      .driver_o       (driver),
      .bits_o         (bits),
      .gray_o         (gray),
      .odd_o          (odd),
      .even_o         (even)
    );
    ssi_channel u_channel (
      .clk_pwm_i, .rst_ni,
      .moves_i        (moves[n/4]),
      .start_i        (start[n/4]),
      .refuse_i       (refuse[n/4]),
      .fall_i         (fall[n/4]),
      .rise_i         (rise[n/4]),
      .enable_i       (enable[n]),
      .shot_i         (single),
      .driver_i       (driver),
      .bits_i         (bits),
      .gray_i         (gray),
      .odd_i          (odd),
      .even_i         (even),
      .data_i         (data[n]),
      .clk_o          (clk_o[n]),
      .active_o       (active[n]),
      .single_o       (begins),
      .shot_o         (shot),
      .position_o     (position[32*n+:32]),
      .parity_error_o (parity_error),
      .refused_o      (refused[8*n+:8])
    );
  end

  // ------------------------------------------------------------------ reading
  logic [8:0] high_part;
  assign high_part = high[9*channel+:9];
  always_comb begin
    rdata_o = 24'h0;
    if (hit) begin
      case ({x_i, place})
        3'b100:  rdata_o = {8'h0, control[16*channel+:16]};
        3'b101:  rdata_o = {16'h0, refused[8*channel+:8]};
        3'b110:  rdata_o = channel[2] ? {group_word[43:32], 2'b00, group_word[31:22]}
                                      : {group_word[21:10], 2'b00, group_word[9:0]};
        3'b001:  rdata_o = {high_part[8], 15'h0, high_part[7:0]};
        default: rdata_o = position[32*channel+:24];
      endcase
    end
  end

endmodule : ssi

`default_nettype wire
