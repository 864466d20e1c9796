// Encoder decoder: compares A, B, C with their levels one SCLK before and says whether the counter moves. All modes of
// I7mn0. Clock clk_ref_i, asynchronous reset. docs/servo_channel.md, Decode.
`default_nettype none

module channel_decode #(
  parameter bit ALeadsUp = 1'b1  // A before B counts up in the clockwise modes
) (
  input  wire logic       clk_ref_i,
  input  wire logic       rst_ni,
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
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni)   last_q <= 3'd0;
    else if (ce_i) last_q <= abc_i;
  end

  logic look;
  assign look = ce_i & ready_i;

  // Place in the hall cycle 001, 011, 010, 110, 100, 101 of {A, B, C}, for {C, B, A} from 7 down to 0; 7 is no place. A
  // table and not a function, which Verilator would make once for each servo IC.
  localparam logic [23:0] HallPlace = {3'd7, 3'd1, 3'd5, 3'd0, 3'd3, 3'd2, 3'd4, 3'd7};

  logic ccw;  // the two codes of a mode differ in this bit
  assign ccw = |(mode_i & (brick_regs_pkg::DecodeX4Cw ^ brick_regs_pkg::DecodeX4Ccw));

  logic [1:0] step;  // along the quadrature cycle 00, 10, 11, 01 of {A, B}
  logic [2:0] hall, last_hall;
  logic       moved;  // by one: as a variable of its own, because Icarus 11 never settles on a bit of `step` read here
  logic       a_rises, hall_up, hall_down, hall_jump, count, down;
  always_comb begin
    step      = 2'd0;
    moved     = 1'b0;
    a_rises   = 1'b0;
    hall      = 3'd7;
    last_hall = 3'd7;
    hall_up   = 1'b0;
    hall_down = 1'b0;
    hall_jump = 1'b0;
    count     = 1'b0;
    down      = 1'b0;
    error_o   = 1'b0;
    if (look) begin
      step    = {abc_i[1], abc_i[0] ^ abc_i[1]} - {last_q[1], last_q[0] ^ last_q[1]};
      moved   = (step == 2'd1) | (step == 2'd3);
      a_rises = abc_i[0] & ~last_q[0];
      down    = (step == 2'd3) ^ ccw ^ ~ALeadsUp;
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
          hall      = HallPlace[5'd3 * {2'b00, abc_i} +: 3];
          last_hall = HallPlace[5'd3 * {2'b00, last_q} +: 3];
          hall_up   = hall != 3'd7 && last_hall != 3'd7 && hall == (last_hall == 3'd5 ? 3'd0 : last_hall + 3'd1);
          hall_down = hall != 3'd7 && last_hall != 3'd7 && last_hall == (hall == 3'd5 ? 3'd0 : hall + 3'd1);
          hall_jump = last_hall != 3'd7 && hall != last_hall && !hall_up && !hall_down;
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
  assign echo_o  = (mode_i == brick_regs_pkg::DecodeMldt) & a_rises;

endmodule : channel_decode

`default_nettype wire
