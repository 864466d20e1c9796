// Watchdog: what watchdog is made of, in compile order.
// Written by tools/rtl_cores.py from the RTL (./dev cores). Do not edit.
common/sync2.sv
board/watchdog.sv
