"""What proves a result: residuals, check, mechanism, states of interfaces; numpy and scipy only."""
