// Control word of one SSI channel, and what it means to the channel: the word of a Brick, or length and mode of a Geo
// PMAC. The high part of a result is held from the read of its low part on. Clock clk_ref_i, asynchronous reset.
// docs/ssi.md, servo-ic:11.3, servo-ic:11.4.
`default_nettype none

module ssi_channel_regs (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        geo_i,
  input  wire logic        we_i,     // of the control word
  input  wire logic        rd_a_i,   // of the position's low part
  input  wire logic [5:0]  flags_i,  // bits 15..10 as written
  input  wire logic [5:0]  count_i,  // bits 5..0
  output logic [15:0]      word_o,   // as it reads
  output logic [8:0]       high_o,   // parity error, position 31..24
  // from and to the channel, which runs on clk_pwm
  input  wire logic        single_i,
  input  wire logic        shot_i,
  input  wire logic [7:0]  position_i,
  input  wire logic        parity_error_i,
  output logic             enable_o,
  output logic             shot_o,
  output logic             driver_o,
  output logic [5:0]       bits_o,
  output logic             gray_o,
  output logic             odd_o,
  output logic             even_o
);

  localparam logic [5:0] LeastBits = 6'd12, MostBits = 6'd32;

  logic [15:0] word_q;
  logic [8:0]  high_q;
  logic        shot_seen_q, geo_gray;
  // A Geo PMAC's code stands in bit 11 as a Brick's: that of the last mode that was on, for a frame that goes on.
  assign geo_gray = count_i[1] ? count_i[0] : word_q[11];
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      word_q      <= 16'h0;
      high_q      <= 9'h0;
      shot_seen_q <= 1'b0;
    end else begin
      // A single frame that begins at the edge of a write is the old word's: it clears nothing of the new one.
      shot_seen_q <= shot_i ^ (we_i & single_i);
      if (we_i) word_q <= {flags_i[5:2], geo_i ? geo_gray : flags_i[1], flags_i[0], 4'h0, count_i};
      else if (shot_i != shot_seen_q) word_q[12] <= 1'b0;
      if (rd_a_i) high_q <= {parity_error_i, position_i};
    end
  end

  // The driver's bit cannot be read.
  assign word_o = geo_i ? {12'h0, word_q[3:0]} : {word_q[15:11], 1'b0, word_q[9:0]};
  assign high_o = high_q;

  logic [5:0] asked;
  assign asked    = word_q[5:0];
  assign enable_o = geo_i ? word_q[1] : word_q[12];
  assign shot_o   = ~geo_i & word_q[13];
  assign driver_o = geo_i | word_q[10];
  assign gray_o   = word_q[11];
  assign odd_o    = ~geo_i & (word_q[15:14] == 2'b01);
  assign even_o   = ~geo_i & (word_q[15:14] == 2'b10);
  assign bits_o   = geo_i ? LeastBits + {2'b00, word_q[3:2], 2'b00}
                          : (asked < LeastBits) ? LeastBits : (asked > MostBits) ? MostBits : asked;

endmodule : ssi_channel_regs

`default_nettype wire
