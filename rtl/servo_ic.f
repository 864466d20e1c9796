// Servo IC (DSPGATE1): clocks and four channels: what servo_ic is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
pins/motor_pins_pkg.sv
regs/brick_regs_pkg.sv
servo_ic/servo_ic_regs.sv
common/sync2.sv
servo_ic/clock_gen.sv
servo_ic/channel_divider.sv
servo_ic/channel_strobe.sv
servo_ic/channel_serial_clock.sv
servo_ic/channel_clocks.sv
servo_ic/channel_sync.sv
servo_ic/channel_input.sv
servo_ic/channel_index.sv
servo_ic/channel_decode.sv
servo_ic/channel_counter.sv
servo_ic/channel_subcount.sv
servo_ic/channel_capture.sv
servo_ic/channel_compare.sv
servo_ic/channel_triangle.sv
servo_ic/channel_pwm.sv
servo_ic/channel_pfm.sv
servo_ic/channel_dac.sv
servo_ic/channel_adc.sv
servo_ic/channel_regs.sv
servo_ic/servo_channel.sv
servo_ic/servo_channels.sv
servo_ic/servo_ic.sv
