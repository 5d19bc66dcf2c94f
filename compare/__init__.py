"""What the runs say: quantities, checks, a verdict and its report. Reads Datasets only, knows no engine."""
