# From the CSV of `pebo-gen simulate` to what a logger on a bench would have written: whole numbers of analogue-to-digital
# converters, a shunt with noise of its own, rows that it lost, cells that it left empty. Deterministic.
BEGIN {
    FS = ","
    print "# Made by models/recordings/logger.awk from a simulation: no motor was measured."
    print "ms,tacho,pwm,shunt"
}
NR == 1 { for (column = 1; column <= NF; column++) place[$column] = column; next }
{
    row = NR - 2
    seed = (seed * 1103 + 12345) % 65536          # a congruential generator: the shunt's last bits
    if (row >= 300 && row < 307 || row == 900) next
    tacho = sprintf("%.0f", 16 * $place["omega"])
    shunt = sprintf("%.0f", 2048 + 80 * $place["i"] + 6 * (seed / 65536 - 0.5))
    if (row % 500 == 250) tacho = ""
    if (row == 1500) tacho = "nan"
    printf "%.2f,%s,%.0f,%s\n", 1000 * $place["t"], tacho, 100 * $place["v"] / 24, shunt
}
