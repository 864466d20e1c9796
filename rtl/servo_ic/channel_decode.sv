// Encoder decoder: compares A, B, C with their levels one SCLK before and says whether the counter moves. All modes of
// I7mn0. Clock clk_ref_i; no reset: before ready_i nothing is decoded. docs/servo_channel.md, Decode.
`default_nettype none

module channel_decode #(
  parameter bit ALeadsUp = 1'b1  // A before B counts up in the clockwise modes
) (
  input  wire logic       clk_ref_i,
  input  wire logic       ce_i,          // SCLK
  input  wire logic       ready_i,
  input  wire logic [3:0] mode_i,        // I7mn0
  input  wire logic       hold_i,        // counter reset: nothing counts
  input  wire logic [2:0] abc_i,         // bit 0 A, 1 B, 2 C, filtered
  input  wire logic       pulse_i,       // PFM pulse since the last SCLK, and its sign
  input  wire logic       pulse_down_i,
  output logic            count_o,       // this edge counts
  output logic            down_o,        // only together with count_o
  output logic            error_o,       // this edge sees an illegal transition
  output logic            mark_o,        // MLDT: excitation, echo
  output logic            echo_o
);

  logic [2:0] last_q;
  always_ff @(posedge clk_ref_i) begin
    if (ce_i) last_q <= abc_i;
  end

  logic look;
  assign look = ce_i & ready_i;

  // Place in the hall cycle 001, 011, 010, 110, 100, 101 of {A, B, C}, for {C, B, A} from 7 down to 0; 7 is no place. A
  // table and not a function, which Verilator would make once for each servo IC.
  localparam logic [23:0] HallPlace = {3'd7, 3'd1, 3'd5, 3'd0, 3'd3, 3'd2, 3'd4, 3'd7};

  logic ccw;  // the two codes of a mode differ in this bit
  assign ccw = |(mode_i & (brick_regs_pkg::DecodeX4Cw ^ brick_regs_pkg::DecodeX4Ccw));

  logic [1:0] step;  // along the quadrature cycle 00, 10, 11, 01 of {A, B}
  logic       moved, a_rises;  // by one step; A
  assign step    = {abc_i[1], abc_i[0] ^ abc_i[1]} - {last_q[1], last_q[0] ^ last_q[1]};
  assign moved   = (step == 2'd1) | (step == 2'd3);
  assign a_rises = abc_i[0] & ~last_q[0];

  logic [2:0] hall, last_hall;
  logic       hall_up, hall_down, hall_jump;
  assign hall      = HallPlace[5'd3 * {2'b00, abc_i} +: 3];
  assign last_hall = HallPlace[5'd3 * {2'b00, last_q} +: 3];
  assign hall_up   = last_hall != 3'd7 && hall == (last_hall == 3'd5 ? 3'd0 : last_hall + 3'd1);
  assign hall_down = hall != 3'd7 && last_hall == (hall == 3'd5 ? 3'd0 : hall + 3'd1);
  assign hall_jump = last_hall != 3'd7 && hall != last_hall && !hall_up && !hall_down;

  logic count, down;
  always_comb begin
    count   = 1'b0;
    down    = (step == 2'd3) ^ ccw ^ ~ALeadsUp;
    error_o = 1'b0;
    if (look) begin
      case (mode_i)
        brick_regs_pkg::DecodePulseCw, brick_regs_pkg::DecodePulseCcw: begin
          count = a_rises;
          down  = ~abc_i[1] ^ ccw;
        end
        brick_regs_pkg::DecodeX1Cw, brick_regs_pkg::DecodeX1Ccw: begin
          count   = moved & ~abc_i[1] & ~last_q[1];
          error_o = step == 2'd2;
        end
        brick_regs_pkg::DecodeX2Cw, brick_regs_pkg::DecodeX2Ccw: begin
          count   = moved & (abc_i[0] ^ last_q[0]);
          error_o = step == 2'd2;
        end
        brick_regs_pkg::DecodeX4Cw, brick_regs_pkg::DecodeX4Ccw: begin
          count   = moved;
          error_o = step == 2'd2;
        end
        brick_regs_pkg::DecodeInternalPulse: begin
          count = pulse_i;
          down  = pulse_down_i;
        end
        brick_regs_pkg::DecodeHallCw, brick_regs_pkg::DecodeHallCcw: begin
          count     = hall_up | hall_down;
          down      = hall_down ^ ccw;
          error_o   = hall == 3'd7 || hall_jump;
        end
        default: count = 1'b0;
      endcase
    end
  end

  assign count_o = count & ~hold_i;
  assign down_o  = down;
  assign mark_o  = look & (mode_i == brick_regs_pkg::DecodeMldt) & pulse_i;
  assign echo_o  = look & (mode_i == brick_regs_pkg::DecodeMldt) & a_rises;

endmodule : channel_decode

`default_nettype wire
