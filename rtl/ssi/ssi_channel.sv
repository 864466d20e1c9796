// One SSI channel: its clock pin, the word that comes in, the last whole word. The group says when the clock falls and
// rises (ssi_group.sv); from a start on the channel takes bits + 1 clocks of it, one more with parity. The first fall
// tells the encoder to hold its position; each rise but the first takes a bit as it was before that rise, the highest
// first. The word is loaded at once, one edge after its last bit. Clock clk_pwm_i, asynchronous reset. docs/ssi.md.
`default_nettype none

module ssi_channel (
  input  wire logic       clk_pwm_i,
  input  wire logic       rst_ni,
  input  wire logic       moves_i,   // with any of the next four: a channel that rests costs a simulation little
  input  wire logic       start_i,
  input  wire logic       refuse_i,
  input  wire logic       fall_i,
  input  wire logic       rise_i,
  input  wire logic       enable_i,  // takes part in the next frame
  input  wire logic       shot_i,    // and in that one only
  input  wire logic       driver_i,  // shows its clock
  input  wire logic [5:0] bits_i,    // of the position
  input  wire logic       gray_i,
  input  wire logic       odd_i,     // one bit of parity more
  input  wire logic       even_i,
  input  wire logic       data_i,    // pin, behind two flip-flops
  output logic            clk_o,     // pin
  output logic            active_o,
  output logic            single_o,  // a single frame begins at this edge
  output logic            shot_o,    // turns when one has begun
  output logic [31:0]     position_o,
  output logic            parity_error_o,
  output logic [7:0]      refused_o
);

  logic        begins, parity_bit, clk_q, shot_q, active_q, first_q, load_q, odd_q, error_q;
  logic [5:0]  rises_q;
  logic [31:0] shift_q, position_q;
  logic [7:0]  refused_q;
  assign begins     = start_i & enable_i;
  assign single_o   = begins & shot_i;
  assign parity_bit = (odd_i | even_i) & (rises_q == 6'd1);

  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      clk_q      <= 1'b1;
      shot_q     <= 1'b0;
      active_q   <= 1'b0;
      first_q    <= 1'b0;
      load_q     <= 1'b0;
      odd_q      <= 1'b0;
      error_q    <= 1'b0;
      rises_q    <= 6'd0;
      shift_q    <= 32'h0;
      position_q <= 32'h0;
      refused_q  <= 8'd0;
    end else begin
      if (moves_i) begin
        clk_q <= (clk_q | rise_i) & ~(fall_i & driver_i & (active_q | begins));
        if (begins) begin
          active_q <= 1'b1;
          first_q  <= 1'b1;
          shift_q  <= 32'h0;
          odd_q    <= 1'b0;
          rises_q  <= bits_i + {5'd0, odd_i | even_i} + 6'd1;
          shot_q   <= shot_q ^ single_o;
        end else if (rise_i && active_q) begin
          first_q <= 1'b0;
          rises_q <= rises_q - 6'd1;
          if (!first_q) odd_q <= odd_q ^ data_i;
          if (!first_q && !parity_bit) shift_q <= {shift_q[30:0], data_i ^ (gray_i & shift_q[0])};
          if (rises_q == 6'd1) begin
            active_q <= 1'b0;
            load_q   <= 1'b1;
          end
        end
        if (refuse_i && enable_i) refused_q <= refused_q + 8'd1;
      end
      if (load_q) begin
        load_q     <= 1'b0;
        position_q <= shift_q;
        error_q    <= (odd_i & ~odd_q) | (even_i & odd_q);
      end
    end
  end

  assign clk_o          = clk_q;
  assign active_o       = active_q;
  assign shot_o         = shot_q;
  assign position_o     = position_q;
  assign parity_error_o = error_q;
  assign refused_o      = refused_q;

endmodule : ssi_channel

`default_nettype wire
