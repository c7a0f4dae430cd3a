# SPDX-License-Identifier: GPL-3.0-or-later
"""Physical and empirical constants, each with its unit and its source."""

# Water, Horvath (2015), table 1
GRAVITY = 9.81  # m/s²
WATER_DENSITY = 1000.0  # kg/m³
SURFACE_TENSION = 0.074  # N/m

# Pierson-Moskowitz (1964), after Horvath (2015), eq. 19
PM_PEAK = 0.855  # ω_p U / g of a fully developed sea, U at 10 m

# JONSWAP, Hasselmann et al. (1973), after Horvath (2015), eq. 28
JONSWAP_ALPHA = 0.076  # α at g F / U² = 1
JONSWAP_ALPHA_EXPONENT = 0.22
JONSWAP_PEAK = 22.0  # ω_p U / g at g F / U² = 1
JONSWAP_SIGMA_BELOW = 0.07  # relative peak width at and below the peak frequency
JONSWAP_SIGMA_ABOVE = 0.09  # and above it
PEAK_ENHANCEMENT = 3.3  # γ, the mean of the JONSWAP records

# Donelan, Hamilton & Hui (1985) with Banner's high-frequency part, after Horvath (2015), eq. 38
DONELAN_BELOW = 2.61
DONELAN_MIDDLE = 2.28
DONELAN_EXPONENT = 1.3
DONELAN_MIDDLE_FROM = 0.95  # ω/ω_p
BANNER_FROM = 1.6  # ω/ω_p
BANNER_OFFSET = -0.4
BANNER_FACTOR = 0.8393
BANNER_EXPONENT = -0.567

# Swell, Horvath (2015), eq. 45
SWELL_SHAPE = 16.0
